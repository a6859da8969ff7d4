// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/tet_mesh.hpp"

namespace tessera::io {

/// Returns the name of a piece, next to its .pvtu: OUT_0003.vtu for OUT.pvtu.
std::filesystem::path pvtu_piece_name(const std::filesystem::path& file, int piece);

/// Writes a mesh in pieces: each piece as a .vtu file like those of write_vtu, and a .pvtu that lists the files. There
/// are no ghost cells. A piece may have no tets.
///
/// Pieces have temporary names until commit(), which renames them and then the .pvtu, so that a program never finds a
/// list of missing pieces. Unless commit() succeeds, the writer removes all of its files; a process that is killed
/// leaves hidden `.tessera-...` files.
class PvtuWriter {
 public:
  /// `like` supplies the name and association of the field, and determines whether original cells are numbered.
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
  std::string arrays_;                            ///< declarations of the arrays of all pieces, as XML
  std::vector<std::filesystem::path> left_over_;  ///< files to remove unless commit() succeeds
  int pieces_ = 0;
};

}  // namespace tessera::io
