// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "scene/tet_mesh.hpp"

namespace tessera::scene {

/// Facts of the whole mesh that views, transfer functions and the projection need, however it is distributed.
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

/// Combines the facts of two parts of one mesh; a part without tets changes nothing. Does not set `mean_thickness`,
/// which needs the box of the whole first, then the sum of volume_sum() over the parts.
MeshFacts joined(const MeshFacts& a, const MeshFacts& b);

/// Volume in units of 2^-100 of the cube over a box's longest side. Integers, so that a sum does not depend on its
/// order; not even 2^28 tets that each fill the box overflow it.
using VolumeSum = __int128;

/// Sum over the mesh's tets, each rounded down, with the box of the whole mesh. Zero if the box has no extent.
VolumeSum volume_sum(const TetMeshView& mesh, const Box& box);

/// mean_thickness() from the box and the volume of the whole mesh.
double mean_thickness(const Box& box, VolumeSum volume);

}  // namespace tessera::scene
