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
#include "volume/brick_layout.hpp"

namespace tessera::volume {

/// Bricks in memory, loaded from the source as they are asked for, within a budget of bytes (Moloney, "Ray Coherence in
/// Parallel Volume Rendering", SFU 2008, 3.3).
///
/// Samples  as stored; i fastest, rows and slices as far apart as BrickLayout::room() says.
/// Threads  any number. A thread holds at most one brick at a time: acquire() may wait until another lets go of its
///          own.
class BrickCache {
 public:
  struct Counts {
    std::uint64_t hits = 0, loads = 0, evictions = 0, bytes_loaded = 0, bytes = 0, peak_bytes = 0;
  };

  /// Throws Error(bad_input) if the budget does not hold the largest brick.
  BrickCache(const scene::SampleSource& source, const BrickLayout& layout, std::uint64_t budget_bytes,
             CachePolicy policy);

  /// A brick's samples, kept until release(). Throws what the source's read() throws.
  const std::byte* acquire(std::size_t brick, scene::Trace* trace);
  void release(std::size_t brick);

  /// proximity: distances by brick number that the next evictions go by, the largest first.
  void set_distances(std::vector<float> distances);

  /// proximity: loads up to `limit` of the bricks that are `wanted` (by number) and not in memory, the nearest to the
  /// cone first, as long as they fit without throwing out one that is nearer, and until `stop`. Between frames, on any
  /// thread; what the source throws is kept for the frame that asks for the brick.
  void preload(int limit, const std::vector<std::uint8_t>& wanted, const std::atomic<bool>& stop, scene::Trace* trace);

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
    std::list<std::size_t>::iterator used;  ///< in by_use_, while ready
  };

  std::uint64_t bytes_of(std::size_t brick) const;
  bool make_room(std::uint64_t bytes, std::unique_ptr<std::byte[]>& buffer);
  void forget(std::size_t brick);

  const scene::SampleSource& source_;
  BrickLayout layout_;
  std::uint64_t budget_;
  CachePolicy policy_;
  std::size_t sample_bytes_;
  bool holds_all_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Entry> entries_;
  std::list<std::size_t> by_use_;                        ///< least recently used first
  std::set<std::pair<float, std::size_t>> by_distance_;  ///< proximity: nearest first
  std::vector<float> distances_;
  Counts counts_;
  std::atomic<std::uint64_t> unlocked_hits_ = 0;
};

}  // namespace tessera::volume
