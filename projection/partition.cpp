// SPDX-License-Identifier: BSD-3-Clause
#include "projection/partition.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace tessera::projection {
namespace {

constexpr int axis_bits = 21;

/// Returns the position along the curve of a cell of the 2^21 grid: Skilling's AxestoTranspose, then the bits of the
/// three axes are interleaved.
std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint32_t axis[3] = {x, y, z};
  for (std::uint32_t q = 1u << (axis_bits - 1); q > 1; q >>= 1) {  // undo excess work, from the highest bit
    const std::uint32_t low = q - 1;
    for (std::uint32_t& a : axis)
      if (a & q) {
        axis[0] ^= low;
      } else {
        const std::uint32_t t = (axis[0] ^ a) & low;
        axis[0] ^= t;
        a ^= t;
      }
  }
  axis[1] ^= axis[0];  // Gray encode
  axis[2] ^= axis[1];
  std::uint32_t flip = 0;
  for (std::uint32_t q = 1u << (axis_bits - 1); q > 1; q >>= 1)
    if (axis[2] & q) flip ^= q - 1;
  std::uint64_t index = 0;
  for (int bit = axis_bits - 1; bit >= 0; --bit)
    for (const std::uint32_t a : axis) index = index << 1 | ((a ^ flip) >> bit & 1);
  return index;
}

std::uint32_t grid_step(double offset, double longest) {
  const double step = offset / longest * (1 << axis_bits);
  if (!(step > 0)) return 0;  // also true for NaN, which a box without extent gives
  return static_cast<std::uint32_t>(std::min(step, static_cast<double>((1 << axis_bits) - 1)));
}

/// A key has 128 bits: its place, then its tet.
constexpr int key_bits = 128, first_digit = 16, later_digit = 8;

int digit_bits(int depth) { return depth == 0 ? first_digit : later_digit; }

/// Returns bits [depth, depth + digit_bits(depth)) of a key, counted from its highest bit. A digit is always within one
/// of the two words.
std::uint64_t digit(const CurveKey& key, int depth) {
  const std::uint64_t word = depth < 64 ? key.place : key.tet;
  const int bits = digit_bits(depth);
  return word >> (64 - depth % 64 - bits) & ((std::uint64_t{1} << bits) - 1);
}

CurveKey with_digit(CurveKey key, int depth, std::uint64_t value) {
  (depth < 64 ? key.place : key.tet) |= value << (64 - depth % 64 - digit_bits(depth));
  return key;
}

/// Returns the key with all bits from `depth` on cleared.
CurveKey prefix(const CurveKey& key, int depth) {
  const auto keep = [](std::uint64_t word, int bits) {
    return bits <= 0 ? 0 : bits >= 64 ? word : word & ~(~std::uint64_t{0} >> bits);
  };
  return {keep(key.place, depth), keep(key.tet, depth - 64)};
}

}  // namespace

int part_in_file_order(std::uint64_t tet, std::uint64_t total, int parts) {
  const auto n = static_cast<std::uint64_t>(parts);
  const std::uint64_t size = total / n, larger = total % n;  // the first `larger` parts have one tet more
  if (tet < larger * (size + 1)) return static_cast<int>(tet / (size + 1));
  return static_cast<int>(larger + (tet - larger * (size + 1)) / size);
}

std::uint64_t first_in_file_order(int part, std::uint64_t total, int parts) {
  const auto n = static_cast<std::uint64_t>(parts), p = static_cast<std::uint64_t>(part);
  return total / n * p + std::min(p, total % n);
}

int part_at_random(std::uint64_t tet, std::uint64_t seed, int parts) {
  std::uint64_t hash = tet + (seed + 1) * 0x9e3779b97f4a7c15u;
  for (int round = 0; round < 2; ++round) {  // a second round separates neighbouring seeds
    hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9u;
    hash = (hash ^ hash >> 27) * 0x94d049bb133111ebu;
    hash ^= hash >> 31;
  }
  return static_cast<int>((hash >> 32) * static_cast<std::uint64_t>(parts) >> 32);
}

std::uint64_t curve_place(const glm::dvec3& point, const scene::Box& box) {
  const glm::dvec3 side = box.high - box.low, offset = point - box.low;
  const double longest = std::max({side.x, side.y, side.z});
  if (!(longest > 0)) return 0;
  return hilbert_index(grid_step(offset.x, longest), grid_step(offset.y, longest), grid_step(offset.z, longest));
}

std::vector<CurveKey> curve_keys(const scene::TetMeshView& mesh, std::span<const std::uint64_t> global_tet,
                                 const scene::Box& box) {
  std::vector<CurveKey> keys(mesh.tets.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, keys.size(), 4096), [&](const auto& range) {
    for (std::size_t t = range.begin(); t != range.end(); ++t) {
      const scene::Tet& tet = mesh.tets[t];
      const glm::dvec3 centroid = (mesh.positions[tet[0]] + mesh.positions[tet[1]]) * 0.25 +
                                  (mesh.positions[tet[2]] + mesh.positions[tet[3]]) * 0.25;
      keys[t] = {curve_place(centroid, box), global_tet.empty() ? t : global_tet[t]};
    }
  });
  return keys;
}

// The size of a part may differ by twice the tolerance, because each of its two splitters may be off by the tolerance.
CurveCut::CurveCut(std::uint64_t total, int parts)
    : tolerance_(total / (250 * static_cast<std::uint64_t>(parts))), splitters_(static_cast<std::size_t>(parts) - 1) {
  if (parts > 1) bins_.push_back({{0, 0}, 0});
  for (std::size_t s = 0; s < splitters_.size(); ++s)
    open_.push_back({s, 0, first_in_file_order(static_cast<int>(s) + 1, total, parts)});
}

std::vector<std::uint64_t> CurveCut::count(std::span<const CurveKey> keys) const {
  const int bits = digit_bits(depth_);
  std::vector<std::uint64_t> counts(bins_.size() << bits);
  for (const CurveKey& key : keys) {
    std::size_t bin = 0;
    if (depth_ > 0) {
      const CurveKey first = prefix(key, depth_);
      const auto at = std::lower_bound(bins_.begin(), bins_.end(), first,
                                       [](const Bin& b, const CurveKey& k) { return b.first < k; });
      if (at == bins_.end() || at->first != first) continue;
      bin = static_cast<std::size_t>(at - bins_.begin());
    }
    ++counts[(bin << bits) + digit(key, depth_)];
  }
  return counts;
}

void CurveCut::narrow(std::span<const std::uint64_t> counts) {
  const int bits = digit_bits(depth_);
  const std::size_t digits = std::size_t{1} << bits;
  std::vector<Bin> finer;
  std::vector<Open> still_open;
  for (const Open& open : open_) {
    const Bin& bin = bins_[open.bin];
    std::uint64_t below = bin.below;
    std::size_t d = 0;
    // Finds the digit at which the target is reached; the last digit if there are fewer keys.
    while (d + 1 < digits && below + counts[(open.bin << bits) + d] < open.target)
      below += counts[(open.bin << bits) + d++];
    const std::uint64_t inside = counts[(open.bin << bits) + d];
    const CurveKey first = with_digit(bin.first, depth_, d);
    // Cutting before or behind this finer bin may be close enough; with a tolerance of 0, it must be exact.
    const std::uint64_t miss_before = open.target > below ? open.target - below : 0;
    const std::uint64_t miss_behind = below + inside > open.target ? below + inside - open.target : 0;
    if (miss_before <= tolerance_ && (miss_before <= miss_behind || d + 1 == digits)) {
      splitters_[open.splitter] = first;
    } else if (miss_behind <= tolerance_ && d + 1 < digits) {
      splitters_[open.splitter] = with_digit(bin.first, depth_, d + 1);
    } else if (depth_ + bits == key_bits) {  // the bin contains one key, because no tet occurs twice
      splitters_[open.splitter] = miss_before == 0 ? first : CurveKey{first.place, first.tet + 1};
    } else {
      if (finer.empty() || finer.back().first != first) finer.push_back({first, below});
      still_open.push_back({open.splitter, finer.size() - 1, open.target});
    }
  }
  depth_ += bits;
  bins_ = std::move(finer);
  open_ = std::move(still_open);
}

int part_on_curve(const CurveKey& key, std::span<const CurveKey> splitters) {
  return static_cast<int>(std::upper_bound(splitters.begin(), splitters.end(), key) - splitters.begin());
}

std::vector<std::uint32_t> parts_of_whole(const scene::TetMeshView& mesh, const Partition& how, int parts) {
  std::vector<std::uint32_t> part_of(mesh.tets.size());
  const auto fill = [&](const auto& part) {
    for (std::size_t t = 0; t < part_of.size(); ++t) part_of[t] = static_cast<std::uint32_t>(part(t));
  };
  switch (how.kind) {
    case PartitionKind::file:
      fill([&](std::size_t t) { return part_in_file_order(t, part_of.size(), parts); });
      break;
    case PartitionKind::random:
      fill([&](std::size_t t) { return part_at_random(t, how.seed, parts); });
      break;
    case PartitionKind::curve: {
      const auto keys = curve_keys(mesh, {}, scene::bounds(mesh));
      CurveCut cut(keys.size(), parts);
      while (!cut.done()) cut.narrow(cut.count(keys));
      fill([&](std::size_t t) { return part_on_curve(keys[t], cut.splitters()); });
      break;
    }
  }
  return part_of;
}

}  // namespace tessera::projection
