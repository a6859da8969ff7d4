// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "tessera/camera.hpp"

namespace tessera::server {

/// Factors by which the sides of images are reduced while something moves.
inline constexpr std::array shrinks = {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0};

/// Returns the reduced size, at least one pixel per side.
ImageSize shrunk(ImageSize size, double shrink);

/// Chooses the size of a client's images while the client moves the view: the largest size whose time, estimated from
/// measured times, is within a budget. Part of a frame's time depends on the data and does not become smaller with the
/// image. If even the smallest size takes too long, a preview of the data is used (tessera/coarse_preview.hpp).
class LevelChoice {
 public:
  explicit LevelChoice(double budget_ms) : budget_ms_(budget_ms) {}

  [[nodiscard]] std::size_t shrink() const { return at_; }
  [[nodiscard]] bool wants_preview() const { return preview_; }
  [[nodiscard]] double budget_ms() const { return budget_ms_; }

  /// Records the time of a frame, from the event until the client reported the frame as painted. `preview` states
  /// whether the frame showed the preview.
  void took(std::size_t shrink, bool preview, double ms);
  /// Records the rendering time of an image in full size. This is the only measurement before anything moves and after
  /// the data have changed.
  void full_took(double ms);

 private:
  /// Returns the first size, from `from` on, whose estimated time is within the budget; one past the last if there is
  /// none.
  [[nodiscard]] std::size_t fitting(std::size_t from, double ms) const;

  double budget_ms_;
  std::size_t at_ = 2;
  bool preview_ = false, measured_ = false;
};

}  // namespace tessera::server
