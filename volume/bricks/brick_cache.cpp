// SPDX-License-Identifier: BSD-3-Clause
#include "volume/bricks/brick_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "scene/error.hpp"

namespace tessera::volume {
namespace {

using Clock = std::chrono::steady_clock;

std::uint64_t nanoseconds_since(Clock::time_point begin) {
  return static_cast<std::uint64_t>(std::chrono::nanoseconds(Clock::now() - begin).count());
}

}  // namespace

BrickCache::BrickCache(const scene::SampleSource& source, const BrickLayout& layout, std::uint64_t budget_bytes,
                       CachePolicy policy)
    : source_(source), layout_(layout), budget_(budget_bytes), policy_(policy), entries_(layout.count()) {
  const std::uint64_t largest = bytes_of(0);
  if (largest > budget_)
    throw scene::bad_input(fmt::format(
        "`memory`: a memory budget of {} bytes does not hold one brick of {} bytes; give more, or smaller bricks",
        budget_, largest));
  std::uint64_t all = 0;
  for (std::size_t brick = 0; brick < entries_.size() && all <= budget_; ++brick) all += bytes_of(brick);
  holds_all_ = all <= budget_;
}

std::uint64_t BrickCache::bytes_of(const BrickLayout& layout, std::size_t brick, scene::SampleType type) {
  const scene::GridIndex room = layout.room(layout.place(brick));
  return static_cast<std::uint64_t>(room[0] * room[1] * room[2]) * scene::size_of(type);
}

std::uint64_t BrickCache::bytes_of(std::size_t brick) const { return bytes_of(layout_, brick, source_.grid().type); }

/// Returns the bytes to allocate for a brick. Slightly smaller bricks at the ends of the axes get as many as the
/// others, because the gap that they would leave in the heap would be too small for other bricks.
std::uint64_t BrickCache::room_for(std::uint64_t bytes) const {
  const std::uint64_t largest = bytes_of(0);
  return holds_all_ || bytes < largest - largest / 8 ? bytes : largest;
}

void BrickCache::forget(std::size_t brick) {
  Entry& entry = entries_[brick];
  by_use_.erase(entry.used);
  if (policy_ == CachePolicy::proximity) by_distance_.erase({distance_of(brick), brick});
  entry.ready.store(nullptr, std::memory_order_relaxed);
  counts_.bytes -= bytes_of(brick);
  ++counts_.evictions;
}

/// Returns the next brick to evict: a brick that is not in use and, with the proximity policy, farther than `beyond`.
/// Returns the number of bricks if there is no such brick.
std::size_t BrickCache::victim(float beyond) const {
  if (policy_ == CachePolicy::proximity) {
    for (auto it = by_distance_.rbegin(); it != by_distance_.rend() && it->first > beyond; ++it)
      if (entries_[it->second].users == 0) return it->second;
  } else {
    for (const std::size_t brick : by_use_)
      if (entries_[brick].users == 0) return brick;
  }
  return entries_.size();
}

/// Evicts bricks until there is room for `bytes` more; returns false if it cannot evict enough. If the memory of an
/// evicted brick has a suitable size, it is returned in `buffer`, so that the heap does not grow by gaps.
bool BrickCache::make_room(std::uint64_t bytes, float beyond, std::unique_ptr<std::byte[]>& buffer) {
  while (counts_.bytes + bytes > budget_) {
    const std::size_t goes = victim(beyond);
    if (goes == entries_.size()) return false;
    forget(goes);
    if (room_for(bytes_of(goes)) == room_for(bytes))
      buffer = std::move(entries_[goes].bytes);
    else
      entries_[goes].bytes.reset();
  }
  return true;
}

/// Evicts any bricks that are not in use. Reads the clock only if it must evict some.
bool BrickCache::make_room_timed(std::uint64_t bytes, std::unique_ptr<std::byte[]>& buffer) {
  if (counts_.bytes + bytes <= budget_) return true;
  const auto begin = Clock::now();
  const bool fits = make_room(bytes, -std::numeric_limits<float>::infinity(), buffer);
  counts_.evict_ns += nanoseconds_since(begin);
  return fits;
}

/// Reads a brick for which there is room, and releases the lock while it reads. Afterwards the brick is not in use yet.
void BrickCache::load(std::size_t brick, std::unique_ptr<std::byte[]> buffer, bool ahead,
                      std::unique_lock<std::mutex>& lock, scene::Trace* trace) {
  Entry& entry = entries_[brick];
  const std::uint64_t bytes = bytes_of(brick);
  entry.loading = true;
  loading_for_rays_ += ahead ? 0 : 1;
  counts_.bytes += bytes;
  counts_.peak_bytes = std::max(counts_.peak_bytes, counts_.bytes);
  lock.unlock();
  const auto begin = Clock::now();
  const auto end = [&] {
    lock.lock();
    entry.loading = false;
    loading_for_rays_ -= ahead ? 0 : 1;
    if (!ahead) counts_.load_ns += nanoseconds_since(begin);
    changed_.notify_all();
  };
  try {
    const scene::TraceScope scope(trace, "read", -1, bytes, 0);
    if (!buffer) buffer = std::make_unique_for_overwrite<std::byte[]>(room_for(bytes));
    const scene::GridIndex place = layout_.place(brick), room = layout_.room(place);
    const scene::SampleLayout layout{source_.grid().type, room[0], room[0] * room[1]};
    source_.read(layout_.box(place), layout, {buffer.get(), bytes});
  } catch (...) {
    end();
    counts_.bytes -= bytes;
    throw;
  }
  end();
  entry.bytes = std::move(buffer);
  entry.users = 0;
  entry.used = by_use_.insert(by_use_.end(), brick);
  if (policy_ == CachePolicy::proximity) by_distance_.insert({distance_of(brick), brick});
  ++(ahead ? counts_.preloads : counts_.loads);
  counts_.bytes_loaded += bytes;
  entry.ready.store(entry.bytes.get(), std::memory_order_release);
}

const std::byte* BrickCache::acquire(std::size_t brick, scene::Trace* trace) {
  Entry& entry = entries_[brick];
  if (holds_all_) {
    // In this case, bricks are never evicted: a brick that is ready remains ready, and use counts are not needed.
    if (const std::byte* ready = entry.ready.load(std::memory_order_acquire)) {
      unlocked_hits_.fetch_add(1, std::memory_order_relaxed);
      return ready;
    }
  }
  std::unique_lock lock(mutex_);
  std::unique_ptr<std::byte[]> buffer;
  for (;;) {
    if (const std::byte* ready = entry.ready.load(std::memory_order_relaxed)) {
      ++counts_.hits;
      ++entry.users;
      by_use_.splice(by_use_.end(), by_use_, entry.used);
      return ready;
    }
    if (!entry.loading && make_room_timed(bytes_of(brick), buffer)) break;
    changed_.wait(lock);
  }
  load(brick, std::move(buffer), false, lock, trace);
  entry.users = 1;
  return entry.bytes.get();
}

void BrickCache::release(std::size_t brick) {
  if (holds_all_) return;
  const std::lock_guard lock(mutex_);
  if (--entries_[brick].users == 0) changed_.notify_all();
}

void BrickCache::set_distances(std::vector<float> distances, float in_use) {
  const std::lock_guard lock(mutex_);
  distances_ = std::move(distances);
  in_use_ = in_use;
  if (policy_ != CachePolicy::proximity) return;
  by_distance_.clear();
  for (const std::size_t brick : by_use_) by_distance_.insert({distances_[brick], brick});
}

BrickCache::Ahead BrickCache::preload(std::size_t brick, bool evicts, scene::Trace* trace) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return loading_for_rays_ == 0; });
  if (resident(brick) || entries_[brick].loading) return Ahead::was_there;
  std::unique_ptr<std::byte[]> buffer;
  const float beyond = evicts ? std::max(in_use_, distance_of(brick)) : std::numeric_limits<float>::infinity();
  if (!make_room(bytes_of(brick), beyond, buffer)) return Ahead::no_room;
  load(brick, std::move(buffer), true, lock, trace);
  return Ahead::loaded;
}

bool BrickCache::resident(std::size_t brick) const {
  return entries_[brick].ready.load(std::memory_order_relaxed) != nullptr;
}

BrickCache::Counts BrickCache::counts() const {
  const std::lock_guard lock(mutex_);
  Counts counts = counts_;
  counts.hits += unlocked_hits_.load(std::memory_order_relaxed);
  return counts;
}

}  // namespace tessera::volume
