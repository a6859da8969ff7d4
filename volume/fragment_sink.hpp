// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scene/pixel_rect.hpp"

namespace tessera::volume {

/// The light of one ray between two of its places, as if nothing lay in front of it or behind.
///
/// Units   red, green, blue: linear light, already weighted with opacity; alpha: opacity. Rounding may leave them 1e-7
///         below zero, or alpha that much above one. Depths are planar, world units.
/// Order   fragments of one pixel do not overlap; `front over back` composites them.
struct RayFragment {
  int x, y;       ///< pixel
  float z_front;  ///< where its light begins: NaN if it has none
  float z_back;   ///< where the part of the ray ends that it is of
  float red, green, blue, alpha;
  float error_bound;  ///< what float lanes may err, so far as they add it up (lane_error_bound.hpp); else 0
};

/// Takes what rays have gathered: an image, a compositor, a message to another process, a light's view.
///
/// Threads   take() and finished() are called by several threads at once, for different pixels.
/// Errors    what they throw ends the cast and comes out of it.
class FragmentSink {
 public:
  FragmentSink() = default;
  virtual ~FragmentSink() = default;
  FragmentSink(const FragmentSink&) = delete;
  FragmentSink& operator=(const FragmentSink&) = delete;

  /// At most one fragment a pixel; none of rays that met nothing of what was cast. The span is gone after the call.
  virtual void take(std::span<const RayFragment> fragments) = 0;
  /// All fragments of these pixels have been given.
  virtual void finished(const scene::PixelRect& /*pixels*/) {}
};

}  // namespace tessera::volume
