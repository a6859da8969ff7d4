// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/tet_mesh.hpp"

namespace tessera::io {

/// Name of a piece, next to its .pvtu: OUT_0003.vtu of OUT.pvtu.
std::filesystem::path pvtu_piece_name(const std::filesystem::path& file, int piece);

/// Writes a mesh in pieces: each a .vtu like write_vtu's, and the .pvtu that lists them. There are no ghost cells; a
/// piece may have no tets.
///
/// Pieces have temporary names until commit(), which renames them and then the .pvtu, so that a reader never finds a
/// list of missing pieces. Without commit(), or if it fails, the writer removes all of its files; a process that is
/// killed leaves hidden `.tessera-...` files.
class PvtuWriter {
 public:
  /// `like` supplies the field's name and association, and whether original cells are numbered.
  PvtuWriter(std::filesystem::path file, const scene::TetMeshView& like);
  ~PvtuWriter();
  PvtuWriter(const PvtuWriter&) = delete;
  PvtuWriter& operator=(const PvtuWriter&) = delete;

  /// Writes the next piece. Throws Error(system_failure) like write_vtu.
  void add(const scene::TetMesh& piece);
  void commit();

 private:
  [[nodiscard]] std::string list() const;

  std::filesystem::path file_;
  std::string arrays_;                            ///< arrays of all pieces, as XML
  std::vector<std::filesystem::path> left_over_;  ///< files to remove unless commit() succeeds
  int pieces_ = 0;
};

}  // namespace tessera::io
