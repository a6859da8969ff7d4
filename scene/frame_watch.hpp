// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <mutex>
#include <stop_token>
#include <utility>

#include "scene/image.hpp"
#include "scene/pixel_rect.hpp"

namespace tessera::scene {

/// Thrown by a frame that ends because a stop was requested. It is not an error.
struct FrameStopped {};

inline void throw_if_stopped(const std::stop_token& stop) {
  if (stop.stop_requested()) throw FrameStopped{};
}

/// Observes a frame while it is rendered: receives pixels when they have their final values, and can stop the frame
/// early.
class FrameWatch {
 public:
  /// Called as `finished(rect, image)` when the pixels of `rect` in `image` are final. Every pixel of the image is in
  /// exactly one of these rectangles. Only one thread calls the function at a time. An exception ends the frame and
  /// propagates to its caller.
  using Finished = std::function<void(const PixelRect&, const Image&)>;

  FrameWatch() = default;
  explicit FrameWatch(std::stop_token stop, Finished finished = {})
      : stop_(std::move(stop)), finished_(std::move(finished)) {}

  [[nodiscard]] const std::stop_token& stop() const { return stop_; }
  [[nodiscard]] bool stopped() const { return stop_.stop_requested(); }
  /// Throws FrameStopped if a stop of the frame was requested.
  void check() const { throw_if_stopped(stop_); }

  /// Must be called before the frame begins.
  void listen(Finished finished) { finished_ = std::move(finished); }
  [[nodiscard]] bool wants_tiles() const { return static_cast<bool>(finished_); }
  /// Reports final pixels. May be called from any thread.
  void finished(const PixelRect& rect, const Image& image) {
    if (!finished_) return;
    const std::lock_guard lock(mutex_);
    if (failed_) return;
    failed_ = true;  // reset below if the call returns; after an exception there are no more calls
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
