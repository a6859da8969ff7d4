#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/tet_mesh.hpp"

namespace tessera::projection {

/// A mesh with what the projection needs and no view changes.
///
/// Canonical order: a tet's vertices are visited in lexicographic order of their positions (x, then y, then z). A face
/// shared by two cells is then computed from the same three points in the same order, to the same bits, whatever
/// indices and orientation its cells use; coincident vertices at a seam included.
class PreparedMesh {
 public:
  /// The mesh must outlive this object. Throws Error(bad_input) beyond 2^32 - 1 tets: split such a mesh over processes.
  explicit PreparedMesh(const scene::TetMesh& mesh);

  [[nodiscard]] const scene::TetMesh& mesh() const { return *mesh_; }
  [[nodiscard]] std::size_t tet_count() const { return mesh_->tets.size(); }

  /// The four vertex indices of a tet in canonical order.
  [[nodiscard]] scene::Tet canonical(std::size_t tet) const {
    const scene::Tet& t = mesh_->tets[tet];
    const std::uint8_t p = permutation_[tet];
    return {t[p & 3], t[(p >> 2) & 3], t[(p >> 4) & 3], t[(p >> 6) & 3]};
  }

  /// Smallest and largest scalar in a tet.
  [[nodiscard]] std::array<double, 2> scalar_bounds(std::size_t tet) const;

 private:
  const scene::TetMesh* mesh_;
  std::vector<std::uint8_t> permutation_;  ///< four 2-bit corner numbers a tet
};

}  // namespace tessera::projection
