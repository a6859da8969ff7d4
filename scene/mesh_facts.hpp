// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "scene/tet_mesh.hpp"

namespace tessera::scene {

/// Facts of the whole mesh that views, transfer functions and the projection need. They do not depend on how the mesh
/// is distributed.
struct MeshFacts {
  Box box;                               ///< bounds()
  std::array<double, 2> scalar_range{};  ///< scalar_range()
  double mean_thickness = 0;             ///< mean_thickness()
  std::uint64_t tets = 0;
  Association association = Association::point;

  bool operator==(const MeshFacts&) const = default;
};

/// The facts of a whole mesh.
MeshFacts facts_of(const TetMeshView& mesh);

/// Combines the facts of two parts of one mesh. A part without tets has no effect. `mean_thickness` is not set, because
/// it requires first the box of the whole mesh and then the sum of volume_sum() over the parts.
MeshFacts joined(const MeshFacts& a, const MeshFacts& b);

/// A volume in units of 2^-100 times the cube of a box's longest side. It is an integer, so that sums do not depend on
/// their order. Even the sum of 2^28 tets that each fill the box does not overflow.
using VolumeSum = __int128;

/// Sum over the mesh's tets, each rounded down, with the box of the whole mesh. Zero if the box has no extent.
VolumeSum volume_sum(const TetMeshView& mesh, const Box& box);

/// Computes mean_thickness() from the box and the volume of the whole mesh.
double mean_thickness(const Box& box, VolumeSum volume);

}  // namespace tessera::scene
