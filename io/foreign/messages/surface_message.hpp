// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "cells/surface.hpp"

namespace tessera::io {

/// A surface filled by TetGen (Si, "TetGen, a Delaunay-Based Quality Tetrahedral Mesh Generator", ACM TOMS 2015) with
/// tets of at most `max_volume` and radius-edge ratio 2, and the fields that go with it.
struct FilledMesh {
  std::vector<glm::dvec3> points;
  std::vector<std::uint32_t> tets;              ///< four a tet
  std::vector<double> depth;                    ///< at the points: distance to the surface, world units
  std::vector<std::vector<double>> attributes;  ///< the surface's, at the points
};

/// How finely a surface is filled.
struct FillSize {
  double max_volume;  ///< of a tet, world units cubed
  double tets;        ///< about how many these are: the volume inside in units of `max_volume`
  bool is_chosen =
      false;  ///< by the user, who may know that it takes long: then 40 times as long, and 8 times the memory
};

/// A surface as JSON for the reader program, and back. surface_of() throws std::exception for other JSON.
nlohmann::json json_of(const cells::Surface& surface);
cells::Surface surface_of(const nlohmann::json& json);

}  // namespace tessera::io
