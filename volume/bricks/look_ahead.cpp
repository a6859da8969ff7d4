// SPDX-License-Identifier: BSD-3-Clause
#include "volume/bricks/look_ahead.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include "scene/start_thread.hpp"
#include "scene/trace.hpp"
#include "volume/bricks/view_frustum.hpp"
#include "volume/bricks/view_motion.hpp"
#include "volume/tile_rays.hpp"

namespace tessera::volume {
namespace {

/// Returns the pixels whose rays determine the samples of a region: all pixels of each tile with pixels in the region,
/// even pixels outside the image.
scene::PixelRect whole_tiles(const scene::PixelRect& region) {
  constexpr int side = TileRays::side;
  const auto up = [](int edge) { return (edge + side - 1) / side * side; };
  return {region.x0 / side * side, region.y0 / side * side, up(region.x1), up(region.y1)};
}

/// Returns the width of a row of a tile's samples, in world units. Rows are at least eight voxels long, even if the
/// tile's rays need fewer (volume/bricks/slab_block.hpp).
float row_width(const scene::GridGeometry& geometry) {
  double widest = 0;
  for (int a = 0; a < 3; ++a) widest = std::max(widest, std::abs(geometry.spacing[a]));
  return static_cast<float>(8 * widest);
}

}  // namespace

LookAhead::LookAhead(BrickCache& bricks, int limit, scene::Trace* trace)
    : bricks_(bricks), limit_(limit), trace_(trace) {}

LookAhead::~LookAhead() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void LookAhead::begin(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region) {
  {
    const std::lock_guard lock(mutex_);
    planned_.clear();
    left_ = limit_;
  }
  const scene::GridGeometry& geometry = bricks_.source().geometry();
  const BrickLayout& layout = bricks_.layout();
  const scene::PixelRect tiles = whole_tiles(region);
  outside_now_ = frustum_distances(camera, size, tiles, geometry, layout);
  std::vector<float> distances = outside_now_;
  if (limit_ > 0) {
    outside_next_ = frustum_distances(last_ ? next_view(*last_, camera) : camera, size, tiles, geometry, layout);
    // Bricks of the next view are kept, too, but are evicted before any bricks that the current view may need (whose
    // distance is 0 or less).
    constexpr float after_all_now = std::numeric_limits<float>::min();
    for (std::size_t brick = 0; brick < distances.size(); ++brick)
      distances[brick] = std::min(distances[brick], std::max(after_all_now, outside_next_[brick]));
  }
  bricks_.set_distances(std::move(distances), row_width(geometry));
  last_ = camera;
}

void LookAhead::frame_shows(const std::vector<std::uint8_t>& visible) {
  if (limit_ > 0) plan(visible, 0);
}

void LookAhead::frame_cast(const std::vector<std::uint8_t>& visible) {
  if (limit_ > 0) plan(visible, -std::numeric_limits<float>::infinity());
}

void LookAhead::plan(const std::vector<std::uint8_t>& visible, float beyond_now) {
  std::vector<std::pair<float, std::size_t>> missing;
  for (std::size_t brick = 0; brick < visible.size(); ++brick)
    if (visible[brick] != 0 && outside_now_[brick] > beyond_now && !bricks_.resident(brick))
      missing.emplace_back(outside_next_[brick], brick);
  const auto most = static_cast<std::ptrdiff_t>(std::min(missing.size(), static_cast<std::size_t>(limit_)));
  std::partial_sort(missing.begin(), missing.begin() + most, missing.end());
  {
    const std::lock_guard lock(mutex_);
    planned_.clear();
    for (std::ptrdiff_t n = 0; n < most; ++n) {
      const auto [outside, brick] = missing[static_cast<std::size_t>(n)];
      planned_.push_back({brick, outside <= 0});
    }
    if (planned_.empty() || left_ == 0) return;
  }
  if (!thread_.joinable()) thread_ = scene::start_thread([this] { work(); });
  changed_.notify_all();
}

void LookAhead::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return ended_ || (!planned_.empty() && left_ > 0); });
    if (ended_) return;
    const Planned next = planned_.front();
    planned_.pop_front();
    // Subtracted before reading, because a frame that begins meanwhile resets the limit.
    --left_;
    lock.unlock();
    auto outcome = BrickCache::Ahead::no_room;
    try {
      const scene::TraceScope scope(trace_, "prepare");
      outcome = bricks_.preload(next.brick, next.in_next, trace_);
    } catch (const std::exception&) {
      outcome = BrickCache::Ahead::no_room;
    }
    lock.lock();
    if (outcome == BrickCache::Ahead::was_there) left_ = std::min(limit_, left_ + 1);
    if (outcome == BrickCache::Ahead::no_room) planned_.clear();
  }
}

}  // namespace tessera::volume
