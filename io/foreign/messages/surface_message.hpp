// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "cells/surface.hpp"

namespace tessera::io {

/// A surface and its fields, filled with tets by TetGen (Si, "TetGen, a Delaunay-Based Quality Tetrahedral Mesh
/// Generator", ACM TOMS 2015). The tets have a volume of at most `max_volume` and a radius-edge ratio of at most 2.
struct FilledMesh {
  std::vector<glm::dvec3> points;
  std::vector<std::uint32_t> tets;              ///< four indices per tet
  std::vector<double> depth;                    ///< distance of each point to the surface, world units
  std::vector<std::vector<double>> attributes;  ///< attributes of the surface, each with a value per point
};

/// How finely a surface is filled.
struct FillSize {
  double max_volume;       ///< largest volume of a tet, world units cubed
  double tets;             ///< estimated number of tets: the enclosed volume divided by `max_volume`
  bool is_chosen = false;  ///< the user chose `max_volume`: at least 40 times the time and 32 times the memory are
                           ///< allowed
};

/// Converts a surface to JSON for the reader program. surface_of() is the inverse and throws std::exception for other
/// JSON.
nlohmann::json json_of(const cells::Surface& surface);
cells::Surface surface_of(const nlohmann::json& json);

}  // namespace tessera::io
