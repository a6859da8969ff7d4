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

/// An opened file whose arrays are read on demand. Copies share the arrays.
struct ForeignFile {
  std::shared_ptr<ArraySource> arrays;
  std::string source;  ///< for messages
  ForeignContents contents;
  bool with_surfaces = false;  ///< surfaces are blocks like others, made of polygons (VTK's type 7)
};

/// Makes the helper open a file. `request` names the reader and its options (readers/common/readers.hpp); this function
/// adds the file. Parts whose names `blocks` of the request does not select are left out; contents.block_names lists
/// all parts. Throws Error(bad_input) with a message of one line. If the request has "surfaces", surfaces count as
/// blocks (ForeignFile::with_surfaces).
ForeignFile open_foreign(std::shared_ptr<HelperProcess> helper, const std::filesystem::path& file,
                         nlohmann::json request);

/// Starts a helper for this file and makes it open the file, like the function above.
ForeignFile open_foreign(const InputFile& file, nlohmann::json request, const ReadProgressFunction& progress = {},
                         HelperTask task = {});

/// A field whose numbers are fetched when the field is first read, and released with the last copy of the field.
cells::BlockField foreign_field(const ForeignFile& file, const ForeignArray& array, scene::Association association);

/// Adds the fields of a part's points or cells. Throws Error(bad_input) for a field that does not have `expected`
/// tuples.
void add_foreign_fields(const ForeignFile& file, const ForeignPart& part, scene::Association association,
                        std::size_t expected, cells::CellBlock& block, const std::string& where);

/// Whether regular grids among the parts are refused, because they are better rendered as volumes, or are converted to
/// hexahedra.
enum class GridsAre { volumes, hexahedra };

/// Converts the parts to blocks. Checks every offset and index, because readers do not. Structured, curvilinear and
/// rectilinear grids become hexahedra. Empty parts are left out. Surfaces in a file that also has volume cells are left
/// out, too, with a line in `notes`, unless they are requested.
/// Throws Error(bad_input) that names the cell at fault, and for images (regular grids) if `grids` is `volumes`.
std::vector<cells::CellBlock> blocks_of(const ForeignFile& file, std::vector<std::string>& notes,
                                        GridsAre grids = GridsAre::volumes);

/// Returns the blocks of blocks_of() with everything that the reader reports about the whole file.
cells::MeshBlocks mesh_of(const ForeignFile& file, GridsAre grids = GridsAre::volumes);

/// Returns the bits of vtkGhostType for each point or cell. Nonzero values of the older array vtkGhostLevels become
/// "duplicate". Empty if the part has neither array.
std::vector<std::uint8_t> ghost_bits(const ForeignFile& file, const std::vector<ForeignArray>& fields, std::size_t n);

}  // namespace tessera::io
