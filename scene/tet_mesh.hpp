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

/// The four vertex indices of a tetrahedron, in either orientation.
using Tet = std::array<std::uint32_t, 4>;

/// A tetrahedral mesh with one scalar field. All readers of meshes return one, and all renderers of meshes use one.
///
/// Shape   positions[v] and, for point data, scalars[v] for each vertex v; tets[t] and, for cell data, scalars[t] for
///         each tet t.
/// Order   The tets of one original cell are adjacent, and cells are in the file's order. The index t therefore sorts
///         by cell and by tet within the cell; it is the last part of the key of the depth order.
/// Units   Positions are in the world units of the file, in double precision, so that cells of a metre at coordinates
///         of 7e6 keep their shape.
/// Holds   All indices are < positions.size(). Positions and the scalars of used vertices (or of tets) are finite;
///         readers leave out cells with NaN. Flat, inverted and duplicate tets are allowed. Vertices may be unused, and
///         several vertices may have the same position.
struct TetMesh {
  std::vector<glm::dvec3> positions;
  std::vector<Tet> tets;
  std::vector<double> scalars;
  Association association = Association::point;
  /// For each tet, the cell of the file from which it was made. Empty if this is the tet's own index.
  std::vector<std::uint64_t> original_cell;
  std::string field_name;  ///< name of the chosen field, with its component: "Velocity:mag"

  [[nodiscard]] std::uint64_t cell_of(std::size_t tet) const {
    return original_cell.empty() ? tet : original_cell[tet];
  }
};

/// A view of a mesh that another object owns, for code that only reads. The arrays must not change while the view is
/// used.
struct TetMeshView {
  std::span<const glm::dvec3> positions;
  std::span<const Tet> tets;
  std::span<const double> scalars;
  Association association = Association::point;
  std::span<const std::uint64_t> original_cell{};
  std::string_view field_name{};

  TetMeshView() = default;
  TetMeshView(const TetMesh& mesh)  // NOLINT(google-explicit-constructor): a view of any mesh
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

/// Returns the volume of the tets divided by the area of the largest face of their box, in world units. This is the
/// mean length inside the mesh of rays that cross the box along its shortest side. Default extinctions are based on
/// this length because, unlike the diagonal of the box, it accounts for plates, shells and scattered parts. Zero for an
/// empty or flat mesh. The result has the same bits for any order of the tets and, if it is computed with
/// mesh_facts.hpp, for any division into parts.
double mean_thickness(const TetMeshView& mesh);

/// Smallest and largest scalar that tets use; {0, 0} if there are no tets.
std::array<double, 2> scalar_range(const TetMeshView& mesh);

/// Returns a subset of a mesh's tets, in the given order, with the vertices that they use, in the order of the mesh.
TetMesh subset(const TetMeshView& mesh, std::span<const std::uint32_t> tets);

/// Throws Error(bad_input), whose message begins with `source`, if the invariants of TetMesh do not hold.
void validate(const TetMeshView& mesh, const std::string& source);

}  // namespace tessera::scene
