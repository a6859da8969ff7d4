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

/// Some thousand points of a field, spread over its volume: enough to know how its values share the volume and roughly
/// what a ray through it meets, at a small part of the cost of reading the file.
namespace tessera::scene {

/// A point of the field that stands for some volume round it.
struct FieldSample {
  double value = 0;
  float volume = 0;           ///< in cubes of the longest side
  std::array<float, 3> at{};  ///< in the box, from 0 to 1 along each of its sides
  std::uint64_t tet = 0;      ///< meshes: index in the whole, by which samples of parts are put in order
};
static_assert(sizeof(FieldSample) == 32);

/// Samples in an order that depends neither on threads nor on how a mesh was divided.
struct FieldSamples {
  std::vector<FieldSample> samples;
  glm::dvec3 sides{0};  ///< of the box, in units of the longest; a grid's box lies along its axes
  double longest = 0;   ///< world units; 0 if there is no extent, and so no sample
  /// Grids: the values of the file nearest to the samples, one each. Of labels those between are not meant.
  std::vector<double> stored{};
};

/// Of a mesh's part, whose tets have the numbers `global_tet` in the whole (empty: their own). Of more than 2^16 tets
/// every 2nd, 3rd ... is looked at, by its number; each gives the more points the larger it is, about 2^14 in all, at
/// low-discrepancy places inside.
FieldSamples sample_mesh(const TetMeshView& part, std::span<const std::uint64_t> global_tet, const MeshFacts& whole);

/// Of a grid: at least 40 along each axis that has an extent, each somewhere in its own part of the grid, where the
/// field is what rays see: trilinear between lattice points, constant in cells of cell data. Blank places are left out.
/// Throws what the source throws.
FieldSamples sample_grid(const SampleSource& source);

}  // namespace tessera::scene
