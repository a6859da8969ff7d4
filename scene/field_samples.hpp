// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/mesh_facts.hpp"
#include "scene/sample_source.hpp"
#include "scene/tet_mesh.hpp"

/// A few thousand points of a field, spread over its volume: enough to estimate how its values are distributed over the
/// volume and roughly what a ray meets, at a small part of the cost of reading the file.
namespace tessera::scene {

/// A point of the field that represents some volume around it.
struct FieldSample {
  double value = 0;
  float volume = 0;           ///< in cubes of the longest side
  std::array<float, 3> at{};  ///< in the box, from 0 to 1 along each of its sides
  std::uint64_t tet = 0;      ///< meshes: index in the whole mesh, by which samples of parts are sorted
};
static_assert(sizeof(FieldSample) == 32);

/// Samples in an order that is independent of threads and of how a mesh was divided.
struct FieldSamples {
  std::vector<FieldSample> samples;
  glm::dvec3 sides{0};  ///< of the box, in units of the longest side; a grid's box is along its axes
  double longest = 0;   ///< world units; 0 without extent, and so without samples
  /// Grids: the value of the file nearest to each sample. For labels, interpolated values have no meaning.
  std::vector<double> stored{};
};

/// Samples of a part of a mesh, whose tets have the indices `global_tet` in the whole mesh (empty: their own). In
/// meshes of more than 2^16 tets only every 2nd, 3rd ... tet is used, by its index. The number of points in a tet grows
/// with its volume, about 2^14 in all, at low-discrepancy places inside.
FieldSamples sample_mesh(const TetMeshView& part, std::span<const std::uint64_t> global_tet, const MeshFacts& whole);

/// Samples of a grid: at least 40 along each axis that has an extent, each at some place in its own part of the grid,
/// with the field as rays see it: trilinear between lattice points, constant in cells of cell data. Blank places are
/// left out. Throws what the source throws.
FieldSamples sample_grid(const SampleSource& source);

}  // namespace tessera::scene
