// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/split_by_times.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>

#include "volume/split/balanced_split.hpp"

namespace tessera::frame {

namespace {

// Between frames ten degrees apart, tile times predict as well as pilot rays, and are free.
constexpr double near_enough = 0.3;
/// How much of one frame's unexpected tile time the model adopts. Lower values adapt late, higher values follow noise.
constexpr double part_of_missed = 0.3;

}  // namespace

bool is_near(const scene::Camera& camera, const scene::Camera& other, const scene::Box& box, double most) {
  if (camera.projection != other.projection) return false;
  const double distance = glm::length(0.5 * (box.low + box.high) - camera.position);
  return glm::length(scene::view_basis(camera).forward - scene::view_basis(other).forward) < most &&
         glm::length(camera.position - other.position) < most * distance;
}

void SplitByTimes::learn(const VolumeJob& job, const scene::Box& box, const std::vector<CastTimes>& ranks) {
  if (!std::ranges::all_of(ranks, &CastTimes::whole)) return;
  std::vector<volume::TileTime> tiles;
  std::vector<double> other_work, tiles_of;
  tiles_ = 0;
  for (const CastTimes& times : ranks) {
    double own = 0;
    for (const volume::TileTime& time : times.tiles) own += 1e3 * static_cast<double>(time.microseconds);
    other_work.push_back(std::max(0.0, 1e9 * times.cpu_seconds - own));
    tiles.insert(tiles.end(), times.tiles.begin(), times.tiles.end());
    tiles_of.push_back(own);
    tiles_ += own;
  }
  // If ranks share a process, its CPU time cannot be attributed to one of them.
  for (auto rank = ranks.begin(); rank != ranks.end(); ++rank)
    if (std::any_of(ranks.begin(), rank, [&](const CastTimes& other) { return other.process == rank->process; }))
      other_work.assign(ranks.size(), 0.0);
  other_work_.resize(ranks.size());
  ++pictures_;
  // The first frames differ from all others: no earlier frame is gathered in parallel, and memory is new. A later frame
  // has little weight, because its time may include the gathering of another frame.
  const double weight = std::max(0.2, 1.0 / std::max(1, pictures_ - 2));
  for (std::size_t rank = 0; rank < other_work.size(); ++rank)
    other_work_[rank] += weight * (other_work[rank] - other_work_[rank]);
  if (tiles.empty()) return;
  compare_with_prediction(tiles_of);
  if (!costs_ || costs_->size() != job.size || !is_near(job.camera, costs_->camera(), box, near_enough))
    costs_.emplace(job.camera, job.size, 0.5 * (box.low + box.high));
  else
    costs_->turn_to(job.camera);
  costs_->learn(tiles);
}

void SplitByTimes::compare_with_prediction(const std::vector<double>& tiles_of) {
  if (predicted_.empty() || tiles_ <= 0) {
    missed_.assign(tiles_of.size(), 0.0);
    return;
  }
  const double all = std::accumulate(predicted_.begin(), predicted_.end(), 0.0);
  for (std::size_t rank = 0; rank < tiles_of.size(); ++rank)
    missed_[rank] += part_of_missed * (tiles_of[rank] / tiles_ - predicted_[rank] / all - missed_[rank]);
}

std::vector<double> SplitByTimes::weights() const {
  const double each =
      (tiles_ + std::accumulate(other_work_.begin(), other_work_.end(), 0.0)) / static_cast<double>(other_work_.size());
  std::vector<double> weights;
  if (tiles_ > 0)
    for (const double other_work : other_work_) weights.push_back(std::max(0.1, 1 - other_work / each));
  return weights;
}

std::optional<volume::ImageSplit> SplitByTimes::find(const VolumeJob& job, const scene::Box& box) {
  predicted_.clear();
  if (!costs_ || costs_->size() != job.size || !is_near(job.camera, costs_->camera(), box, near_enough))
    return std::nullopt;
  volume::TileCosts costs = *costs_;
  costs.turn_to(job.camera);
  costs.sum();
  std::vector<double> more = other_work_;
  const double all = costs.of({0, 0, job.size.width, job.size.height});
  for (std::size_t rank = 0; rank < more.size(); ++rank) more[rank] += missed_[rank] * all;
  const volume::ImageSplit split = volume::balanced_split(costs, more);
  for (int rank = 0; rank < split.processes(); ++rank) {
    double cost = 0;
    for (const scene::PixelRect& part : split.parts(rank)) cost += costs.of(part);
    predicted_.push_back(cost);
  }
  return split;
}

}  // namespace tessera::frame
