// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cells/block_choice.hpp"
#include "io/mesh/mesh_formats.hpp"

namespace tessera::io {

/// A data set in a separate file that a VTK file lists: a piece of a .pvtu, or a block of a .vtm or .vtpc.
struct ListedPiece {
  std::filesystem::path file;
  std::string list;   ///< the file that lists it
  std::string block;  ///< block names from the root of the list to this block; empty: a piece of one data set
  std::string type;   ///< type of the data set's file, if it was inspected
};

struct PieceList {
  std::vector<ListedPiece> pieces;                             ///< in file order; only blocks of the choice, and
                                                               ///< surfaces only if requested
  std::vector<std::string> block_names, surface_names, notes;  ///< surface_names: surfaces that are left out
  std::string format;                                          ///< description
  bool with_surfaces = false;                                  ///< the chosen blocks may be surfaces
  const Format* of = nullptr;                                  ///< format of the list
};

/// Whether a file that begins like VTK XML is an unstructured grid in pieces or a list of blocks, regardless of the
/// name.
bool lists_pieces(const InputFile& file);

/// Returns the pieces of a file that lists_pieces() accepts. Relative paths are resolved against the directory of the
/// file. The files that a .pvtu lists need not exist. The files of blocks are inspected, because surfaces are left out
/// unless `with_surfaces` is set. Throws Error(bad_input).
PieceList piece_list(const InputFile& file, const cells::BlockChoice& choice, bool with_surfaces = false);

/// Reads pieces [first, last) of a list. Each piece of a data set becomes a block whose `source` is the piece's file;
/// regular grids become hexahedra. Throws Error(bad_input) that names the piece at fault.
cells::MeshBlocks read_pieces(const PieceList& list, std::size_t first, std::size_t last,
                              const ReadProgressFunction& progress = {});

}  // namespace tessera::io
