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

/// What the proximity cache goes by, and the bricks that are loaded ahead for the next frame: by the view that follows
/// if the camera goes on as it did (view_motion.hpp; Moloney, "Ray Coherence in Parallel Volume Rendering", SFU
/// 2008, 3.3 and 7.1, who has it as an outlook).
///
/// Threads  one of its own, from the first brick on, which goes on from frame to frame: while rays of one are cast the
///          bricks of the next are read, behind those that rays wait for. What the source throws is dropped: the frame
///          that asks for the brick gets it.
/// Bits     none depend on it.
class LookAhead {
 public:
  /// At most `limit` bricks a frame; 0: distances alone. `bricks` and `trace` must outlive it.
  LookAhead(BrickCache& bricks, int limit, scene::Trace* trace);
  ~LookAhead();
  LookAhead(const LookAhead&) = delete;
  LookAhead& operator=(const LookAhead&) = delete;

  /// A frame of a region begins: what was planned for it and is not there yet is dropped.
  void begin(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region);
  /// Which bricks the frame's function shows: those that this view cannot have are loaded from now on, the deepest in
  /// the next view first.
  void frame_shows(const std::vector<std::uint8_t>& visible);
  /// The frame's rays are cast: those that this view has and no ray asked for come last.
  void frame_cast(const std::vector<std::uint8_t>& visible);

 private:
  struct Planned {
    std::size_t brick;
    bool in_next;  ///< the next view may have it; others, next to it, throw nothing out
  };

  void plan(const std::vector<std::uint8_t>& visible, float beyond_now);
  void work();

  BrickCache& bricks_;
  const int limit_;
  scene::Trace* const trace_;
  std::optional<scene::Camera> last_;  ///< view of the frame before
  std::vector<float> outside_now_, outside_next_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Planned> planned_;
  int left_ = 0;  ///< of the frame's limit
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace tessera::volume
