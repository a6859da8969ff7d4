#include "volume/brick_cache.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scene/error.hpp"

namespace tessera::volume {

BrickCache::BrickCache(const scene::SampleSource& source, const BrickLayout& layout, std::uint64_t budget_bytes,
                       CachePolicy policy)
    : source_(source),
      layout_(layout),
      budget_(budget_bytes),
      policy_(policy),
      sample_bytes_(scene::size_of(source.grid().type)),
      entries_(layout.count()) {
  const std::uint64_t largest = bytes_of(0);
  if (largest > budget_)
    throw scene::bad_input(fmt::format(
        "`memory`: a memory budget of {} bytes does not hold one brick of {} bytes; give more, or smaller bricks",
        budget_, largest));
  std::uint64_t all = 0;
  for (std::size_t brick = 0; brick < entries_.size() && all <= budget_; ++brick) all += bytes_of(brick);
  holds_all_ = all <= budget_;
}

std::uint64_t BrickCache::bytes_of(std::size_t brick) const {
  const scene::GridIndex room = layout_.room(layout_.place(brick));
  return static_cast<std::uint64_t>(room[0] * room[1] * room[2]) * sample_bytes_;
}

void BrickCache::forget(std::size_t brick) {
  Entry& entry = entries_[brick];
  by_use_.erase(entry.used);
  if (policy_ == CachePolicy::proximity) by_distance_.erase({distances_.empty() ? 0.0f : distances_[brick], brick});
  entry.ready.store(nullptr, std::memory_order_relaxed);
  counts_.bytes -= bytes_of(brick);
  ++counts_.evictions;
}

/// Throws bricks out that nobody holds until `bytes` more fit; false if too many are held. A thrown-out brick's memory
/// of the right size comes back as `buffer`, so that the heap does not grow by its gaps.
bool BrickCache::make_room(std::uint64_t bytes, std::unique_ptr<std::byte[]>& buffer) {
  while (counts_.bytes + bytes > budget_) {
    std::size_t victim = entries_.size();
    if (policy_ == CachePolicy::proximity) {
      for (auto it = by_distance_.rbegin(); it != by_distance_.rend() && victim == entries_.size(); ++it)
        if (entries_[it->second].users == 0) victim = it->second;
    } else {
      for (auto it = by_use_.begin(); it != by_use_.end() && victim == entries_.size(); ++it)
        if (entries_[*it].users == 0) victim = *it;
    }
    if (victim == entries_.size()) return false;
    forget(victim);
    if (bytes_of(victim) == bytes)
      buffer = std::move(entries_[victim].bytes);
    else
      entries_[victim].bytes.reset();
  }
  return true;
}

const std::byte* BrickCache::acquire(std::size_t brick, scene::Trace* trace) {
  Entry& entry = entries_[brick];
  if (holds_all_) {
    // Nothing is ever thrown out: what is ready stays, and needs no holding.
    if (const std::byte* ready = entry.ready.load(std::memory_order_acquire)) {
      unlocked_hits_.fetch_add(1, std::memory_order_relaxed);
      return ready;
    }
  }
  std::unique_lock lock(mutex_);
  const std::uint64_t bytes = bytes_of(brick);
  std::unique_ptr<std::byte[]> buffer;
  for (;;) {
    if (const std::byte* ready = entry.ready.load(std::memory_order_relaxed)) {
      ++counts_.hits;
      ++entry.users;
      by_use_.splice(by_use_.end(), by_use_, entry.used);
      return ready;
    }
    if (!entry.loading && make_room(bytes, buffer)) break;
    changed_.wait(lock);
  }
  entry.loading = true;
  counts_.bytes += bytes;
  counts_.peak_bytes = std::max(counts_.peak_bytes, counts_.bytes);
  lock.unlock();
  try {
    const scene::TraceScope scope(trace, "read", -1, bytes, 0);
    if (!buffer) buffer = std::make_unique_for_overwrite<std::byte[]>(bytes);
    const scene::GridIndex place = layout_.place(brick), room = layout_.room(place);
    const scene::SampleLayout layout{source_.grid().type, room[0], room[0] * room[1]};
    source_.read(layout_.box(place), layout, {buffer.get(), bytes});
  } catch (...) {
    lock.lock();
    entry.loading = false;
    counts_.bytes -= bytes;
    changed_.notify_all();
    throw;
  }
  lock.lock();
  entry.loading = false;
  entry.bytes = std::move(buffer);
  entry.users = 1;
  entry.used = by_use_.insert(by_use_.end(), brick);
  if (policy_ == CachePolicy::proximity) by_distance_.insert({distances_.empty() ? 0.0f : distances_[brick], brick});
  ++counts_.loads;
  counts_.bytes_loaded += bytes;
  entry.ready.store(entry.bytes.get(), std::memory_order_release);
  changed_.notify_all();
  return entry.bytes.get();
}

void BrickCache::release(std::size_t brick) {
  if (holds_all_) return;
  const std::lock_guard lock(mutex_);
  if (--entries_[brick].users == 0) changed_.notify_all();
}

void BrickCache::set_distances(std::vector<float> distances) {
  const std::lock_guard lock(mutex_);
  distances_ = std::move(distances);
  if (policy_ != CachePolicy::proximity) return;
  by_distance_.clear();
  for (const std::size_t brick : by_use_) by_distance_.insert({distances_[brick], brick});
}

void BrickCache::preload(int limit, const std::vector<std::uint8_t>& wanted, const std::atomic<bool>& stop,
                         scene::Trace* trace) {
  std::vector<std::pair<float, std::size_t>> missing;
  for (std::size_t brick = 0; brick < distances_.size(); ++brick)
    if (wanted[brick] != 0 && !resident(brick)) missing.emplace_back(distances_[brick], brick);
  const std::size_t count = std::min(missing.size(), static_cast<std::size_t>(limit));
  std::partial_sort(missing.begin(), missing.begin() + static_cast<std::ptrdiff_t>(count), missing.end());
  for (std::size_t n = 0; n < count && !stop.load(std::memory_order_relaxed); ++n) {
    const auto [distance, brick] = missing[n];
    {
      const std::lock_guard lock(mutex_);
      const bool fits = counts_.bytes + bytes_of(brick) <= budget_;
      if (!fits && (by_distance_.empty() || by_distance_.rbegin()->first <= distance)) return;
    }
    try {
      acquire(brick, trace);
    } catch (const scene::Error&) {
      return;
    }
    release(brick);
  }
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
