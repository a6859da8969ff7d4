#include "volume/look_ahead.hpp"

#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

#include "scene/start_thread.hpp"
#include "scene/trace.hpp"
#include "volume/view_cone.hpp"
#include "volume/view_motion.hpp"

namespace tessera::volume {

LookAhead::LookAhead(BrickCache& bricks, int limit, scene::Trace* trace)
    : bricks_(bricks),
      limit_(limit),
      trace_(trace),
      half_brick_(static_cast<float>(half_brick(bricks.source().geometry(), bricks.layout()))) {}

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
  std::vector<float> distances = cone_distances(camera, size, region, geometry, layout);
  if (limit_ > 0) {
    const scene::Camera next = last_ ? next_view(*last_, camera) : camera;
    const std::vector<float> of_next = cone_distances(next, size, region, geometry, layout);
    // What the next view needs stays too, but after all that this one may need.
    for (std::size_t brick = 0; brick < distances.size(); ++brick)
      distances[brick] = std::min(distances[brick], of_next[brick] + half_brick_);
    outside_now_ = frustum_distances(camera, size, region, geometry, layout);
    outside_next_ = frustum_distances(next, size, region, geometry, layout);
  }
  bricks_.set_distances(std::move(distances), half_brick_);
  last_ = camera;
}

void LookAhead::frame_shows(const std::vector<std::uint8_t>& visible) {
  if (limit_ > 0) plan(visible, half_brick_);
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
    for (std::ptrdiff_t n = 0; n < most; ++n) planned_.push_back(missing[static_cast<std::size_t>(n)].second);
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
    const std::size_t brick = planned_.front();
    planned_.pop_front();
    // Taken before it is read: a frame that begins meanwhile has a limit of its own.
    --left_;
    lock.unlock();
    auto outcome = BrickCache::Ahead::no_room;
    try {
      const scene::TraceScope scope(trace_, "prepare");
      outcome = bricks_.preload(brick, trace_);
    } catch (const std::exception&) {
      outcome = BrickCache::Ahead::no_room;
    }
    lock.lock();
    if (outcome == BrickCache::Ahead::was_there) left_ = std::min(limit_, left_ + 1);
    if (outcome == BrickCache::Ahead::no_room) planned_.clear();
  }
}

}  // namespace tessera::volume
