// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "scene/camera.hpp"
#include "scene/pixel_rect.hpp"
#include "volume/bricks/brick_cache.hpp"

namespace tessera::volume {

/// Computes the distances for the proximity cache, and preloads bricks for the next frame: those of the view that
/// follows if the camera continues its motion (view_motion.hpp; Moloney, "Ray Coherence in Parallel Volume Rendering",
/// SFU 2008, 3.3 and 7.1, where it is future work).
///
/// Threads   One thread, started with the first brick to preload and kept between frames. It reads bricks of the next
///           frame while rays of the current one are cast, but gives way to reads that rays wait for. Exceptions of the
///           source are dropped; the frame that requests the brick gets them.
/// Bits      Images do not depend on it.
class LookAhead {
 public:
  /// Preloads at most `limit` bricks per frame; 0: only computes distances. `bricks` and `trace` must outlive it.
  LookAhead(BrickCache& bricks, int limit, scene::Trace* trace);
  ~LookAhead();
  LookAhead(const LookAhead&) = delete;
  LookAhead& operator=(const LookAhead&) = delete;

  /// Begins a frame of a region: bricks planned for it that are not loaded yet are dropped.
  void begin(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region);
  /// Receives the bricks that are visible in the frame. Starts to load those that are outside the current view, in the
  /// order of their depth in the next view.
  void frame_shows(const std::vector<std::uint8_t>& visible);
  /// The frame's rays have been cast: visible bricks of the current view that no ray requested may now be loaded, too.
  void frame_cast(const std::vector<std::uint8_t>& visible);

 private:
  struct Planned {
    std::size_t brick;
    bool in_next;  ///< inside the next view; other bricks, near it, do not evict any
  };

  void plan(const std::vector<std::uint8_t>& visible, float beyond_now);
  void work();

  BrickCache& bricks_;
  const int limit_;
  scene::Trace* const trace_;
  std::optional<scene::Camera> last_;  ///< view of the previous frame
  std::vector<float> outside_now_, outside_next_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Planned> planned_;
  int left_ = 0;  ///< remaining bricks of the frame's limit
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace tessera::volume
