// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "scene/sample_source.hpp"
#include "scene/trace.hpp"
#include "volume/bricks/brick_layout.hpp"

namespace tessera::volume {

/// Bricks in memory, loaded from the source on request, within a budget of bytes (Moloney, "Ray Coherence in Parallel
/// Volume Rendering", SFU 2008, 3.3).
///
/// Samples   As stored; i varies fastest, and BrickLayout::room() determines the strides of rows and slices.
/// Threads   Any number. A thread may hold at most one brick at a time: acquire() may wait until another thread
///           releases its brick.
class BrickCache {
 public:
  struct Counts {
    std::uint64_t hits = 0, loads = 0, evictions = 0, bytes_loaded = 0, bytes = 0, peak_bytes = 0;
    std::uint64_t preloads = 0;               ///< bricks loaded ahead of their use; not included in `loads`
    std::uint64_t load_ns = 0, evict_ns = 0;  ///< time of acquire() only: for reading, and for making room
  };
  enum class Ahead { loaded, was_there, no_room };

  /// Throws Error(bad_input) if the budget does not hold the largest brick.
  BrickCache(const scene::SampleSource& source, const BrickLayout& layout, std::uint64_t budget_bytes,
             CachePolicy policy);

  /// Returns a brick's samples, which are valid until release(). Throws what the source's read() throws.
  const std::byte* acquire(std::size_t brick, scene::Trace* trace);
  void release(std::size_t brick);

  /// For CachePolicy::proximity: sets the distance of each brick, by number. Bricks with the largest distance are
  /// evicted first. A brick at most `in_use` away may be needed at any time, and is not evicted for preloading.
  void set_distances(std::vector<float> distances, float in_use = 0);

  /// For CachePolicy::proximity: loads a brick that has not been requested yet. It is not loaded if this would evict a
  /// brick that is not farther, or one in use; with `evicts` false, if this would evict any brick. May be called on any
  /// thread. Waits while acquire() reads on other threads, which have priority. Throws like acquire().
  Ahead preload(std::size_t brick, bool evicts, scene::Trace* trace);

  /// Bytes of the samples of a brick.
  static std::uint64_t bytes_of(const BrickLayout& layout, std::size_t brick, scene::SampleType type);
  /// Bytes of the table of all bricks (loaded or not), including their distances, and their visibility in a frame.
  static std::uint64_t bytes_of_table(const BrickLayout& layout) {
    return layout.count() * (sizeof(Entry) + 2 * sizeof(float) + 2);
  }
  /// Bytes that a brick needs in addition to its samples: its nodes in the orders of use and distance, and the heap's
  /// overhead.
  static constexpr std::uint64_t bytes_beside_brick = 128;

  [[nodiscard]] Counts counts() const;
  [[nodiscard]] const BrickLayout& layout() const { return layout_; }
  [[nodiscard]] const scene::SampleSource& source() const { return source_; }
  [[nodiscard]] bool resident(std::size_t brick) const;
  [[nodiscard]] bool holds_all() const { return holds_all_; }

 private:
  struct Entry {
    std::unique_ptr<std::byte[]> bytes;
    std::atomic<const std::byte*> ready{nullptr};
    std::uint32_t users = 0;
    bool loading = false;
    std::list<std::size_t>::iterator used;  ///< position in by_use_, while the brick is ready
  };

  std::uint64_t bytes_of(std::size_t brick) const;
  std::uint64_t room_for(std::uint64_t bytes) const;
  float distance_of(std::size_t brick) const { return distances_.empty() ? 0.0f : distances_[brick]; }
  std::size_t victim(float beyond) const;
  bool make_room(std::uint64_t bytes, float beyond, std::unique_ptr<std::byte[]>& buffer);
  bool make_room_timed(std::uint64_t bytes, std::unique_ptr<std::byte[]>& buffer);
  void forget(std::size_t brick);
  void load(std::size_t brick, std::unique_ptr<std::byte[]> buffer, bool ahead, std::unique_lock<std::mutex>& lock,
            scene::Trace* trace);

  const scene::SampleSource& source_;
  BrickLayout layout_;
  std::uint64_t budget_;
  CachePolicy policy_;
  bool holds_all_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Entry> entries_;
  std::list<std::size_t> by_use_;                        ///< least recently used first
  std::set<std::pair<float, std::size_t>> by_distance_;  ///< proximity: nearest first
  std::vector<float> distances_;
  float in_use_ = 0;
  int loading_for_rays_ = 0;
  Counts counts_;
  std::atomic<std::uint64_t> unlocked_hits_ = 0;
};

}  // namespace tessera::volume
