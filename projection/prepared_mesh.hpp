// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/tet_mesh.hpp"

namespace tessera::projection {

/// Sorts the corners of every tet into canonical order, the lexicographic order of their positions (x, then y, then z).
/// A face that two cells share is then computed from the same three points in the same order, with the same bits,
/// whatever indices and orientation its cells use. This includes coincident vertices at a seam.
void order_corners(scene::TetMesh& mesh);

/// A mesh with the data that projection needs and that do not depend on the view.
class PreparedMesh {
 public:
  /// The mesh must outlive this object. If order_corners() has not been called for the mesh, its tets are copied, which
  /// takes 16 bytes per tet. Throws Error(bad_input) for more than 2^32 - 1 tets: split such a mesh over processes.
  explicit PreparedMesh(const scene::TetMeshView& mesh);
  PreparedMesh(PreparedMesh&&) = default;
  PreparedMesh& operator=(PreparedMesh&&) = default;

  [[nodiscard]] const scene::TetMeshView& mesh() const { return mesh_; }
  [[nodiscard]] std::size_t tet_count() const { return mesh_.tets.size(); }

  /// The tets, with their corners in canonical order.
  [[nodiscard]] std::span<const scene::Tet> tets() const { return tets_; }

  /// Smallest and largest scalar in a tet.
  [[nodiscard]] std::array<double, 2> scalar_bounds(std::size_t tet) const;

  /// Tets of a block: block b has tets b * block_tets to (b + 1) * block_tets; the last block may be shorter.
  static constexpr std::size_t block_tets = 64;
  [[nodiscard]] std::size_t block_count() const { return block_bounds_.size(); }
  /// Smallest and largest scalar in a block, so that whole blocks can be culled; a quarter of a byte per tet.
  [[nodiscard]] std::array<double, 2> block_scalar_bounds(std::size_t block) const { return block_bounds_[block]; }
  /// Whether all scalars are representable as float, like those of most files: comparing them in float is then exact.
  [[nodiscard]] bool scalars_are_floats() const { return scalars_are_floats_; }

 private:
  scene::TetMeshView mesh_;
  std::vector<scene::Tet> ordered_;  ///< a copy of the tets if the mesh's own tets are in another order
  std::span<const scene::Tet> tets_;
  std::vector<std::array<double, 2>> block_bounds_;
  bool scalars_are_floats_ = false;
};

}  // namespace tessera::projection
