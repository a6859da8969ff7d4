// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cells/surface.hpp"

namespace tessera::readers {

/// Tets inside a surface. Points of the surface come first.
struct FilledSurface {
  std::vector<glm::dvec3> points;
  std::vector<std::uint32_t> tets;       ///< four a tet
  std::vector<std::uint32_t> triangles;  ///< three a boundary or facet triangle
};

/// With tets of at most `max_volume`, or with no points but the surface's own where that can be. Throws
/// Error(bad_input, "SOURCE: ...").
FilledSurface fill(const cells::Surface& surface, std::optional<double> max_volume, const std::string& source);

/// Gives points from number `known` on the mean of their neighbours in the tets, ring after ring.
void fill_unknown(const FilledSurface& mesh, std::size_t known, std::vector<double>& values);

/// Distance of every point to the nearest boundary triangle, world units, exactly 0 on the boundary.
std::vector<double> depth_below_surface(const FilledSurface& filled);

/// The surface's attributes at the filled mesh's points, which TetGen does not compute for the points it adds: linear
/// in each tet of `coarse`, the same surface filled with no points but its own (so a linear attribute stays linear).
/// Where even that needed added points, these get the mean of their neighbours.
std::vector<std::vector<double>> spread_attributes(const cells::Surface& surface, const FilledSurface& coarse,
                                                   const FilledSurface& filled);

}  // namespace tessera::readers
