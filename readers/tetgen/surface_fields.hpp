// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cells/surface.hpp"

namespace tessera::readers {

/// The tets inside a surface. The first points are those of the surface.
struct FilledSurface {
  std::vector<glm::dvec3> points;
  std::vector<std::uint32_t> tets;       ///< four indices per tet
  std::vector<std::uint32_t> triangles;  ///< three indices per triangle of the boundary or of an inner facet
};

/// Fills a surface with tets of at most `max_volume`. Without `max_volume`, adds no points if possible. Throws
/// Error(bad_input, "SOURCE: ...").
FilledSurface fill(const cells::Surface& surface, std::optional<double> max_volume, const std::string& source);

/// Sets the values of points from index `known` on to the mean of their neighbours in the tets, layer by layer.
void fill_unknown(const FilledSurface& mesh, std::size_t known, std::vector<double>& values);

/// Distance of every point to the nearest boundary triangle, world units, exactly 0 on the boundary.
std::vector<double> depth_below_surface(const FilledSurface& filled);

/// Returns the surface's attributes at the points of the filled mesh, because TetGen does not compute them for added
/// points. They are linear in each tet of `coarse`, which is the same surface filled without added points, so that a
/// linear attribute stays linear. If even `coarse` has added points, these get the mean of their neighbours.
std::vector<std::vector<double>> spread_attributes(const cells::Surface& surface, const FilledSurface& coarse,
                                                   const FilledSurface& filled);

}  // namespace tessera::readers
