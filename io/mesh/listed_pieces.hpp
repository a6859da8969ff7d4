// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cells/block_choice.hpp"
#include "io/mesh/mesh_formats.hpp"

namespace tessera::io {

/// A data set of its own file that a list of VTK's has: a piece of a .pvtu, or a block of a .vtm or .vtpc.
struct ListedPiece {
  std::filesystem::path file;
  std::string list;  ///< the file that lists it
  std::string
      block;         ///< its name, the path of the names of the blocks around it and its own; empty: a piece of a whole
  std::string type;  ///< of its file, where that has been looked at
};

struct PieceList {
  std::vector<ListedPiece> pieces;                             ///< in their order; the chosen blocks' volumes
  std::vector<std::string> block_names, surface_names, notes;  ///< surfaces: those that are left out
  std::string format;                                          ///< in words
  bool with_surfaces = false;                                  ///< of the chosen blocks
  const Format* of = nullptr;                                  ///< the list's
};

/// Whether a file that begins as VTK XML does is an unstructured grid in pieces, or a list of blocks, whatever its
/// name.
bool lists_pieces(const InputFile& file);

/// The pieces of such a file, their paths as it gives them, relative ones against its folder. Those of a .pvtu need not
/// exist; blocks are looked at, since surfaces are left out unless `with_surfaces`. Throws Error(bad_input).
PieceList piece_list(const InputFile& file, const cells::BlockChoice& choice, bool with_surfaces = false);

/// Pieces [first, last) of a list, those of a whole a block each, whose `source` is the piece's file; regular grids as
/// hexahedra. Throws Error(bad_input) that names the piece at fault.
cells::MeshBlocks read_pieces(const PieceList& list, std::size_t first, std::size_t last,
                              const ReadProgressFunction& progress = {});

}  // namespace tessera::io
