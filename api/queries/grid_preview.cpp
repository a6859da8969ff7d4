// SPDX-License-Identifier: BSD-3-Clause
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "api/queries/preview.hpp"

namespace tessera::api {
namespace {

/// Returns the number of samples along each axis, about in proportion to `n` and with a product of at most `samples`.
GridIndex fewer(const GridIndex& n, std::uint64_t samples, std::int64_t least) {
  const auto counts = [&](double factor) {
    GridIndex m{};
    for (std::size_t a = 0; a < 3; ++a)
      m[a] = std::clamp(static_cast<std::int64_t>(static_cast<double>(n[a]) * factor), std::min(least, n[a]), n[a]);
    return m;
  };
  double small = 0, large = 1;
  for (int halving = 0; halving < 50; ++halving) {
    const double middle = 0.5 * (small + large);
    const GridIndex m = counts(middle);
    const double count = static_cast<double>(m[0]) * static_cast<double>(m[1]) * static_cast<double>(m[2]);
    (count <= static_cast<double>(samples) ? small : large) = middle;
  }
  return counts(small);
}

/// Returns the index of the coarse sample, out of m, to which sample i of n contributes.
std::int64_t nearest(std::int64_t i, std::int64_t n, std::int64_t m, bool cells) {
  if (m == n) return i;
  if (cells) return std::min(i * m / n, m - 1);
  return n > 1 ? (2 * i * (m - 1) + (n - 1)) / (2 * (n - 1)) : 0;
}

/// Returns the geometry with fewer lattice points, which are evenly spaced in lattice indices.
GridGeometry geometry_of(const GridGeometry& g, const GridIndex& points) {
  GridGeometry coarse = g;
  coarse.points = points;
  for (std::size_t a = 0; a < 3; ++a) {
    const double step = static_cast<double>(g.points[a] - 1) / static_cast<double>(points[a] - 1);
    if (!g.rectilinear(a)) {
      coarse.spacing[static_cast<int>(a)] = g.spacing[static_cast<int>(a)] * step;
      continue;
    }
    coarse.coordinates[a].clear();
    for (std::int64_t i = 0; i < points[a]; ++i) {
      const double at = static_cast<double>(i) * step;
      const std::int64_t below = std::min(static_cast<std::int64_t>(at), g.points[a] - 2);
      coarse.coordinates[a].push_back(i + 1 == points[a] ? g.lattice(a, g.points[a] - 1)
                                                         : std::lerp(g.lattice(a, below), g.lattice(a, below + 1),
                                                                     at - static_cast<double>(below)));
    }
  }
  return coarse;
}

}  // namespace

std::shared_ptr<const scene::SampleSource> coarser(const scene::SampleSource& source, std::uint64_t samples,
                                                   const std::stop_token& stop) {
  const scene::Grid& grid = source.grid();
  const bool cells = grid.geometry.association == Association::cell;
  const GridIndex n = grid.geometry.samples(), m = fewer(n, samples, cells ? 1 : 2);
  std::vector<float> means(static_cast<std::size_t>(m[0] * m[1] * m[2]));
  std::vector<std::int64_t> column(static_cast<std::size_t>(n[0]));
  for (std::int64_t i = 0; i < n[0]; ++i) column[static_cast<std::size_t>(i)] = nearest(i, n[0], m[0], cells);
  tbb::parallel_for(std::int64_t{0}, m[2], [&](std::int64_t k) {
    const auto slice = static_cast<std::size_t>(m[0] * m[1]);
    std::vector<double> sums(slice, 0);
    std::vector<std::uint32_t> counts(slice, 0);
    // The samples that contribute to slice k are contiguous.
    const auto first = [&](std::int64_t slice_of) {
      std::int64_t low = 0, high = n[2];
      while (low < high) {
        const std::int64_t middle = low + (high - low) / 2;
        if (nearest(middle, n[2], m[2], cells) < slice_of)
          low = middle + 1;
        else
          high = middle;
      }
      return low;
    };
    constexpr std::int64_t numbers_at_once = 1 << 20;
    const std::int64_t rows_at_once = std::clamp<std::int64_t>(numbers_at_once / n[0], 1, n[1]);
    std::vector<double> rows(static_cast<std::size_t>(n[0] * rows_at_once));
    for (std::int64_t z = first(k); z < first(k + 1); ++z)
      for (std::int64_t y = 0; y < n[1]; y += rows_at_once) {
        if (stop.stop_requested()) return;
        const std::int64_t last = std::min(y + rows_at_once, n[1]);
        const auto part = std::span(rows).first(static_cast<std::size_t>(n[0] * (last - y)));
        source.read(SampleBox{{0, y, z}, {n[0], last, z + 1}}, part);
        const double* number = part.data();
        for (std::int64_t j = y; j < last; ++j) {
          const auto row = static_cast<std::size_t>(m[0] * nearest(j, n[1], m[1], cells));
          for (const std::int64_t i : column) {
            const double sample = *number++;
            if (!std::isfinite(sample)) continue;
            sums[row + static_cast<std::size_t>(i)] += sample;
            ++counts[row + static_cast<std::size_t>(i)];
          }
        }
      }
    for (std::size_t i = 0; i < slice; ++i)
      means[slice * static_cast<std::size_t>(k) + i] =
          counts[i] > 0 ? static_cast<float>(sums[i] / counts[i]) : std::numeric_limits<float>::quiet_NaN();
  });
  if (stop.stop_requested()) return nullptr;
  scene::Grid coarse = grid;
  const std::int64_t more = cells ? 1 : 0;
  coarse.geometry = geometry_of(grid.geometry, {m[0] + more, m[1] + more, m[2] + more});
  return scene::MemorySource::of(std::move(coarse), std::move(means), "coarse preview");
}

}  // namespace tessera::api
