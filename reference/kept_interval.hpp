// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "reference/view.hpp"
#include "scene/selection.hpp"

namespace tessera::reference {

/// Planar depths; empty unless nearest < farthest.
struct DepthInterval {
  double nearest, farthest;
  const scene::HalfSpace* nearest_plane = nullptr;  ///< that ends it there; null: the view does
  const scene::HalfSpace* farthest_plane = nullptr;
};

/// What of the ray through pixel coordinates (x, y) is in view and in all half-spaces. A ray that runs in a plane (to
/// 1e-13 of the distances to the eye and the origin) counts to the side that the ray shifted by (e, e^2) pixel in (x,
/// y) is on, e positive and infinitely small, as in ray_tet.hpp.
DepthInterval kept_interval(const View& view, double x, double y, std::span<const scene::HalfSpace> kept);

}  // namespace tessera::reference
