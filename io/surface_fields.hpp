#pragma once

#include <vector>

#include "io/surface.hpp"

namespace tessera::io {

/// Distance of every point to the nearest boundary triangle, world units, exactly 0 on the boundary.
std::vector<double> depth_below_surface(const FilledSurface& filled);

/// The surface's attributes at the filled mesh's points, which TetGen does not compute for the points it adds: linear
/// in each tet of `coarse`, the same surface filled with no points but its own (so a linear attribute stays linear).
/// Where even that needed added points, these get the mean of their neighbours.
std::vector<std::vector<double>> spread_attributes(const Surface& surface, const FilledSurface& coarse,
                                                   const FilledSurface& filled);

}  // namespace tessera::io
