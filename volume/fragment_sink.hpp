// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scene/pixel_rect.hpp"

namespace tessera::volume {

/// The light of one ray between two positions, as if no matter were in front of or behind them.
///
/// Units     red, green, blue: linear light, premultiplied by opacity; alpha: opacity. Rounding may make them negative
///           by 1e-7, or alpha larger than one by as much. Depths are planar, in world units.
/// Order     Fragments of one pixel do not overlap; `front over back` composites them.
struct RayFragment {
  int x, y;       ///< pixel
  float z_front;  ///< depth at which the light begins; NaN if the fragment has no light
  float z_back;   ///< depth at which the ray's part ends
  float red, green, blue, alpha;
  float error_bound;  ///< error recorded by float lanes (lane_error_bound.hpp), otherwise 0
};

/// Receives the light of rays. Implementations are an image, a compositor, a message to another process, or a light's
/// view.
///
/// Threads   take() and finished() are called by several threads concurrently, for different pixels.
/// Errors    Exceptions thrown here end the cast and propagate out of it.
class FragmentSink {
 public:
  FragmentSink() = default;
  virtual ~FragmentSink() = default;
  FragmentSink(const FragmentSink&) = delete;
  FragmentSink& operator=(const FragmentSink&) = delete;

  /// Receives at most one fragment per pixel, and none for rays that did not meet the part of the volume that is cast.
  /// The span is invalid after the call.
  virtual void take(std::span<const RayFragment> fragments) = 0;
  /// Called when all fragments of these pixels have been passed to take().
  virtual void finished(const scene::PixelRect& /*pixels*/) {}
};

}  // namespace tessera::volume
