// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <mutex>
#include <stop_token>
#include <utility>

#include "scene/image.hpp"
#include "scene/pixel_rect.hpp"

namespace tessera::scene {

/// Thrown through a frame that was asked to stop, to its caller. It is not an error.
struct FrameStopped {};

inline void throw_if_stopped(const std::stop_token& stop) {
  if (stop.stop_requested()) throw FrameStopped{};
}

/// Observes a frame while it is rendered: receives pixels when they have their final values, and may stop it early.
class FrameWatch {
 public:
  /// `finished(rect, image)`: the pixels of `rect` in `image` are final; every pixel of the image is in one such
  /// rectangle. Called by one thread at a time; an exception ends the frame and propagates from it.
  using Finished = std::function<void(const PixelRect&, const Image&)>;

  FrameWatch() = default;
  explicit FrameWatch(std::stop_token stop, Finished finished = {})
      : stop_(std::move(stop)), finished_(std::move(finished)) {}

  [[nodiscard]] const std::stop_token& stop() const { return stop_; }
  [[nodiscard]] bool stopped() const { return stop_.stop_requested(); }
  /// Throws FrameStopped once the frame must stop.
  void check() const { throw_if_stopped(stop_); }

  /// Call before the frame begins.
  void listen(Finished finished) { finished_ = std::move(finished); }
  [[nodiscard]] bool wants_tiles() const { return static_cast<bool>(finished_); }
  /// May be called from any thread.
  void finished(const PixelRect& rect, const Image& image) {
    if (!finished_) return;
    const std::lock_guard lock(mutex_);
    if (failed_) return;
    failed_ = true;  // unless it returns: no calls after an exception
    finished_(rect, image);
    failed_ = false;
  }

 private:
  std::stop_token stop_;
  Finished finished_;
  std::mutex mutex_;
  bool failed_ = false;
};

}  // namespace tessera::scene
