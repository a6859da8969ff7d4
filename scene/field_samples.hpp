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

/// A few thousand samples of a field, distributed over its volume. They are sufficient to estimate how much of the
/// volume each value occupies and, roughly, what a ray meets, at a small fraction of the cost of reading the file.
namespace tessera::scene {

/// A sample of the field that represents a volume around a point.
struct FieldSample {
  double value = 0;
  float volume = 0;           ///< represented volume, in units of the cube of the longest side
  std::array<float, 3> at{};  ///< position in the box, from 0 to 1 along each side
  std::uint64_t tet = 0;      ///< meshes: index of the tet in the whole mesh; samples of parts are sorted by it
};
static_assert(sizeof(FieldSample) == 32);

/// Samples in an order that does not depend on the number of threads and on how a mesh is divided.
struct FieldSamples {
  std::vector<FieldSample> samples;
  glm::dvec3 sides{0};  ///< sides of the box, in units of the longest side; the box of a grid is along the grid's axes
  double longest = 0;   ///< longest side, world units; 0 if the box has no extent; then there are no samples
  /// Grids: for each sample the nearest value of the file, because interpolated values of labels have no meaning.
  std::vector<double> stored{};
};

/// Samples a part of a mesh. `global_tet` contains the indices of the part's tets in the whole mesh; if it is empty,
/// the part is the whole mesh. In meshes of more than 2^16 tets, only the tets whose index is a multiple of a stride
/// are used. The number of points in a tet grows with its volume. There are about 2^14 points in all. Their places in
/// the tets are those of a low-discrepancy sequence.
FieldSamples sample_mesh(const TetMeshView& part, std::span<const std::uint64_t> global_tet, const MeshFacts& whole);

/// Samples a grid: at least 40 points along each axis that has an extent. The grid is divided into equal parts, with
/// one point at some place in each part. The field is the one that rays see: trilinear between lattice points, or
/// constant in the cells of cell data. Blank places are left out. Throws the errors of the source.
FieldSamples sample_grid(const SampleSource& source);

}  // namespace tessera::scene
