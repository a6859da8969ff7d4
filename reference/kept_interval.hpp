// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "reference/view.hpp"
#include "scene/selection.hpp"

namespace tessera::reference {

/// An interval of planar depths; empty unless nearest < farthest.
struct DepthInterval {
  double nearest, farthest;
  const scene::HalfSpace* nearest_plane = nullptr;  ///< the plane at the near end; null: the end of the view
  const scene::HalfSpace* farthest_plane = nullptr;
};

/// Returns the part of the ray through pixel coordinates (x, y) that is in view and in all half-spaces. A ray in a
/// plane (to 1e-13 of the distances to the eye and the origin) belongs to the side of the ray shifted by (e, e^2) pixel
/// in (x, y), where e is positive and infinitely small, as in ray_tet.hpp.
DepthInterval kept_interval(const View& view, double x, double y, std::span<const scene::HalfSpace> kept);

}  // namespace tessera::reference
