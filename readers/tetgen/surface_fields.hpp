// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cells/surface.hpp"

namespace tessera::readers {

/// Tets inside a surface. The points of the surface come first.
struct FilledSurface {
  std::vector<glm::dvec3> points;
  std::vector<std::uint32_t> tets;       ///< four indices per tet
  std::vector<std::uint32_t> triangles;  ///< three indices per boundary or facet triangle
};

/// Fills with tets of at most `max_volume`, or if possible without points other than the surface's. Throws
/// Error(bad_input, "SOURCE: ...").
FilledSurface fill(const cells::Surface& surface, std::optional<double> max_volume, const std::string& source);

/// Sets the values of points from index `known` on to the mean of their neighbours in the tets, layer by layer.
void fill_unknown(const FilledSurface& mesh, std::size_t known, std::vector<double>& values);

/// Distance of every point to the nearest boundary triangle, world units, exactly 0 on the boundary.
std::vector<double> depth_below_surface(const FilledSurface& filled);

/// The surface's attributes at the filled mesh's points, which TetGen does not compute for added points: linear in each
/// tet of `coarse`, the same surface filled without added points (so a linear attribute stays linear). If even that
/// needed added points, these get the mean of their neighbours.
std::vector<std::vector<double>> spread_attributes(const cells::Surface& surface, const FilledSurface& coarse,
                                                   const FilledSurface& filled);

}  // namespace tessera::readers
