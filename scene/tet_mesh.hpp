// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/camera.hpp"
#include "tessera/association.hpp"

namespace tessera::scene {

using tessera::Association;

/// Four vertex indices of a tetrahedron, either orientation.
using Tet = std::array<std::uint32_t, 4>;

/// A tetrahedral mesh with one scalar field: the result of every reader and the input of every renderer.
///
/// Shape   positions[v] and, for point data, scalars[v] for each vertex v; tets[t] and, for cell data, scalars[t] for
///         each tet t.
/// Order   tets of one original cell are adjacent and cells are in the file's order, so the index t is the rank of the
///         pair (original cell, sub-tet): the last part of the depth order's key.
/// Units   world units of the file in double precision, so metre-size cells at coordinates of 7e6 keep their shape.
/// Holds   all indices < positions.size(); positions finite; scalars of used vertices (or of tets) finite: cells with
///         NaN are blanked by the reader. Flat, inverted and duplicate tets are allowed. Vertices may be unused, or
///         coincide.
struct TetMesh {
  std::vector<glm::dvec3> positions;
  std::vector<Tet> tets;
  std::vector<double> scalars;
  Association association = Association::point;
  /// Original (file) cell of each tet; empty if that is the tet's own index.
  std::vector<std::uint64_t> original_cell;
  std::string field_name;  ///< as chosen, with component: "Velocity:mag"

  [[nodiscard]] std::uint64_t cell_of(std::size_t tet) const {
    return original_cell.empty() ? tet : original_cell[tet];
  }
};

/// A mesh owned by another object: the same arrays by reference, for code that only reads. They must stay unchanged
/// while the view is used.
struct TetMeshView {
  std::span<const glm::dvec3> positions;
  std::span<const Tet> tets;
  std::span<const double> scalars;
  Association association = Association::point;
  std::span<const std::uint64_t> original_cell{};
  std::string_view field_name{};

  TetMeshView() = default;
  TetMeshView(const TetMesh& mesh)  // NOLINT(google-explicit-constructor): every mesh can be read
      : positions(mesh.positions),
        tets(mesh.tets),
        scalars(mesh.scalars),
        association(mesh.association),
        original_cell(mesh.original_cell),
        field_name(mesh.field_name) {}

  [[nodiscard]] std::uint64_t cell_of(std::size_t tet) const {
    return original_cell.empty() ? tet : original_cell[tet];
  }
};

/// Box of the vertices that tets use. Empty if there are no tets.
Box bounds(const TetMeshView& mesh);

/// Volume of the tets over the largest face of their box: the mean length of matter on rays that cross the box along
/// its shortest side. World units; default extinctions refer to this length, which unlike the box's diagonal accounts
/// for plates, shells and scattered parts. Zero for an empty or flat mesh. The same bits for any order of the tets and,
/// computed with mesh_facts.hpp, for any division into parts.
double mean_thickness(const TetMeshView& mesh);

/// Smallest and largest scalar that tets use; {0, 0} if there are no tets.
std::array<double, 2> scalar_range(const TetMeshView& mesh);

/// A subset of a mesh's tets, in the given order, with the vertices that they use in the mesh's order.
TetMesh subset(const TetMeshView& mesh, std::span<const std::uint32_t> tets);

/// Throws Error(bad_input, "SOURCE: ...") if an index, size or number breaks the invariants above.
void validate(const TetMeshView& mesh, const std::string& source);

}  // namespace tessera::scene
