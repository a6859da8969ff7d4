// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cells/mesh_blocks.hpp"
#include "io/files/input_file.hpp"
#include "io/foreign/client/helper_process.hpp"
#include "io/foreign/messages/array_source.hpp"
#include "io/foreign/messages/foreign_data.hpp"

namespace tessera::io {

/// An opened file whose arrays are read on demand. Copies share them.
struct ForeignFile {
  std::shared_ptr<ArraySource> arrays;
  std::string source;  ///< for messages
  ForeignContents contents;
  bool with_surfaces = false;  ///< surfaces are blocks like others, made of polygons (VTK's type 7)
};

/// Lets the helper read a file. `request` names the reader and its options (readers/common/readers.hpp); this function
/// adds the file. Parts whose names are not selected by `blocks` of the request are left out; contents.block_names
/// lists all. Throws Error(bad_input) in one line. With "surfaces", surfaces count as blocks
/// (ForeignFile::with_surfaces).
ForeignFile open_foreign(std::shared_ptr<HelperProcess> helper, const std::filesystem::path& file,
                         nlohmann::json request);

/// The same with a new helper of its own.
ForeignFile open_foreign(const InputFile& file, nlohmann::json request, const ReadProgressFunction& progress = {},
                         HelperTask task = {});

/// A field whose numbers are fetched when it is first read and released with the last copy.
cells::BlockField foreign_field(const ForeignFile& file, const ForeignArray& array, scene::Association association);

/// Adds the fields of a part's points or cells. Throws Error(bad_input) for a field that does not have `expected`
/// tuples.
void add_foreign_fields(const ForeignFile& file, const ForeignPart& part, scene::Association association,
                        std::size_t expected, cells::CellBlock& block, const std::string& where);

/// Whether regular grids among the parts are refused, because they are better rendered as volumes, or become cells.
enum class GridsAre { volumes, hexahedra };

/// The parts as blocks. Checks every offset and index, which readers do not. Structured, curvilinear and rectilinear
/// grids become hexahedra. Empty parts are left out; so are surfaces in a file that also has volume cells, unless they
/// are requested; `notes` then gets a line.
/// Throws Error(bad_input) naming the cell at fault, and for images (regular grids).
std::vector<cells::CellBlock> blocks_of(const ForeignFile& file, std::vector<std::string>& notes,
                                        GridsAre grids = GridsAre::volumes);

/// The same, with what the reader reports about the whole file.
cells::MeshBlocks mesh_of(const ForeignFile& file, GridsAre grids = GridsAre::volumes);

/// Bits of vtkGhostType for each point or cell; a nonzero value of the older vtkGhostLevels becomes "duplicate". Empty
/// if the part has neither array.
std::vector<std::uint8_t> ghost_bits(const ForeignFile& file, const std::vector<ForeignArray>& fields, std::size_t n);

}  // namespace tessera::io
