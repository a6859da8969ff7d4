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

/// Computes the distances for the proximity cache, and preloads bricks for the next frame. These are the bricks of the
/// view that follows if the camera continues its motion (view_motion.hpp; Moloney, "Ray Coherence in Parallel Volume
/// Rendering", SFU 2008, 3.3 and 7.1, where this is future work).
///
/// Threads   One thread, started with the first brick to preload and kept between frames, reads bricks of the next
///           frame while rays of the current frame are cast. Reads that rays wait for have priority. Exceptions of the
///           source are dropped; the frame that requests the brick gets them.
/// Bits      Images do not depend on preloading.
class LookAhead {
 public:
  /// Preloads at most `limit` bricks per frame; with 0, only computes distances. `bricks` and `trace` must outlive this
  /// object.
  LookAhead(BrickCache& bricks, int limit, scene::Trace* trace);
  ~LookAhead();
  LookAhead(const LookAhead&) = delete;
  LookAhead& operator=(const LookAhead&) = delete;

  /// Begins a frame of a region. Bricks that were planned for this frame but have not been loaded yet are dropped.
  void begin(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region);
  /// Receives the bricks that are visible in the frame. Starts to load those of them that are outside the current view,
  /// in the order of their depth in the next view.
  void frame_shows(const std::vector<std::uint8_t>& visible);
  /// Must be called when the frame's rays have been cast. Visible bricks of the current view that no ray requested may
  /// now be loaded, too.
  void frame_cast(const std::vector<std::uint8_t>& visible);

 private:
  struct Planned {
    std::size_t brick;
    bool in_next;  ///< the brick is inside the next view; bricks that are only near that view do not evict others
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
  int left_ = 0;  ///< how many bricks may still be loaded in this frame
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace tessera::volume
