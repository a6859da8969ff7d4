// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/frame_collector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace tessera::exchange {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::uint64_t bytes_worth_merging = 1 << 20;

}  // namespace

FrameCollector::FrameCollector(int projectors, const TileMap& map, int compositor)
    : projectors_(projectors),
      numbers_(&map.tiles(compositor)),
      tiles_(numbers_->size()),
      debts_(static_cast<std::size_t>(projectors)) {
  for (int projector = 0; projector < projectors; ++projector)
    ends_awaited_ += end_goes_to(projector, map.compositors()) == compositor ? 1 : 0;
}

FrameCollector::Tile& FrameCollector::tile(std::uint32_t number) {
  return const_cast<Tile&>(std::as_const(*this).tile(number));
}

const FrameCollector::Tile& FrameCollector::tile(std::uint32_t number) const {
  const auto found = std::lower_bound(numbers_->begin(), numbers_->end(), number);
  if (found == numbers_->end() || *found != number)
    throw scene::Error(
        scene::ErrorCode::system_failure,
        fmt::format("exchange: tile {} came to the wrong compositor; run one version of the program", number));
  return tiles_[static_cast<std::size_t>(found - numbers_->begin())];
}

void FrameCollector::begin(int projector, const FrameBegin& begin, std::span<const std::byte> bits) {
  if (begin.tiles != tiles_.size())
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("exchange: projector {} announces {} tiles to a compositor that has {}; all ranks "
                                   "must be given the same arguments",
                                   projector, begin.tiles, tiles_.size()));
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    Tile& tile = tiles_[i];
    if (tile.final_depth.empty()) tile.final_depth.assign(static_cast<std::size_t>(projectors_), -infinity);
    const bool contributes = (bits[i / 8] >> (i % 8) & std::byte{1}) != std::byte{0};
    tile.contributors += contributes ? 1 : 0;
    if (!contributes) tile.final_depth[static_cast<std::size_t>(projector)] = infinity;
  }
  longest_ray_ = std::max(longest_ray_, begin.longest_ray);
  longest_edge_ = std::max(longest_edge_, begin.longest_edge);
  ++begins_;
  advance();
}

void FrameCollector::end(const FrameEnd& sums) {
  sums_ = sum(sums_, sums);
  ++ends_;
}

double FrameCollector::add(int projector, TilePart part) {
  Tile& to = tile(part.tile);
  const double start = std::exchange(to.final_depth[static_cast<std::size_t>(projector)], part.final_depth);
  part.start_depth = start;
  part.projector = projector;
  if (part.last) ++to.ended;
  to.bytes += part.records.size();
  if (part.records.size() > 0) to.parts.push_back(std::move(part));
  return start;
}

double FrameCollector::final_depth(const Tile& tile) const {
  if (!has_all_begins()) return -infinity;
  return *std::min_element(tile.final_depth.begin(), tile.final_depth.end());
}

bool FrameCollector::has_work(std::uint32_t number) const {
  const Tile& of = tile(number);
  if (of.composited) return false;
  if (of.contributors > 0 && is_complete(of)) return true;
  return of.bytes >= bytes_worth_merging && final_depth(of) > of.merged_to;
}

FrameCollector::Waiting FrameCollector::take(std::uint32_t number) {
  Tile& from = tile(number);
  const bool all = is_complete(from);
  from.merged_to = all ? infinity : final_depth(from);
  std::stable_sort(from.parts.begin(), from.parts.end(),
                   [](const TilePart& a, const TilePart& b) { return a.start_depth < b.start_depth; });
  // A part that begins deeper than the depth to which other projectors are complete stays unmerged, because an unmerged
  // part takes only a fifth of the memory.
  const auto ahead = std::find_if(from.parts.begin(), from.parts.end(), [&](const TilePart& part) {
    return !all && part.start_depth >= from.merged_to && std::isfinite(part.start_depth);
  });
  Waiting waiting{{std::make_move_iterator(from.parts.begin()), std::make_move_iterator(ahead)}, from.merged_to, all};
  from.parts.erase(from.parts.begin(), ahead);
  from.bytes = 0;
  for (const TilePart& part : from.parts) from.bytes += part.records.size();
  return waiting;
}

void FrameCollector::finish(std::uint32_t number) {
  tile(number).composited = true;
  advance();
}

void FrameCollector::advance() {
  if (!has_all_begins()) return;
  while (first_unfinished_ < tiles_.size() &&
         (tiles_[first_unfinished_].composited || tiles_[first_unfinished_].contributors == 0))
    ++first_unfinished_;
}

bool FrameCollector::finished() const {
  return has_all_begins() && has_all_ends() && first_unfinished_ == tiles_.size();
}

bool FrameCollector::is_ahead(const Debt& debt) const {
  if (first_unfinished_ == tiles_.size()) return false;
  const std::uint32_t first = (*numbers_)[first_unfinished_];
  if (debt.tile != first) return debt.tile > first;
  return std::isfinite(debt.start_depth) && debt.start_depth > final_depth(tiles_[first_unfinished_]);
}

void FrameCollector::owe(int projector, std::uint32_t number, double start_depth, std::uint64_t bytes) {
  debts_[static_cast<std::size_t>(projector)].push_back({number, start_depth, bytes});
}

std::uint64_t FrameCollector::pay(int projector) {
  std::uint64_t due = 0;
  std::erase_if(debts_[static_cast<std::size_t>(projector)], [&](const Debt& debt) {
    if (is_ahead(debt)) return false;
    due += debt.bytes;
    return true;
  });
  return due;
}

}  // namespace tessera::exchange
