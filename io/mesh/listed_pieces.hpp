// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cells/block_choice.hpp"
#include "io/mesh/mesh_formats.hpp"

namespace tessera::io {

/// A data set in a file of its own, listed in a VTK file: a piece of a .pvtu, or a block of a .vtm or .vtpc.
struct ListedPiece {
  std::filesystem::path file;
  std::string list;   ///< the file that lists it
  std::string block;  ///< path of block names down to its own; empty: a piece of one data set
  std::string type;   ///< type of its file, if that was inspected
};

struct PieceList {
  std::vector<ListedPiece> pieces;                             ///< in file order; the volumes of the chosen blocks
  std::vector<std::string> block_names, surface_names, notes;  ///< surface_names: surfaces that are left out
  std::string format;                                          ///< description
  bool with_surfaces = false;                                  ///< the chosen blocks may be surfaces
  const Format* of = nullptr;                                  ///< format of the list
};

/// Whether a file that begins like VTK XML is an unstructured grid in pieces or a list of blocks, whatever its name.
bool lists_pieces(const InputFile& file);

/// The pieces of such a file. Relative paths are resolved against its directory. Files of a .pvtu need not exist; files
/// of blocks are inspected, because surfaces are left out unless `with_surfaces`. Throws Error(bad_input).
PieceList piece_list(const InputFile& file, const cells::BlockChoice& choice, bool with_surfaces = false);

/// Reads pieces [first, last) of a list. Pieces of one data set become a block each, whose `source` is the piece's
/// file; regular grids become hexahedra. Throws Error(bad_input) that names the piece at fault.
cells::MeshBlocks read_pieces(const PieceList& list, std::size_t first, std::size_t last,
                              const ReadProgressFunction& progress = {});

}  // namespace tessera::io
