// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::cells {

/// Names of blocks of a file, as given by a caller; empty: all blocks.
using BlockChoice = std::vector<std::string>;

/// Whether a name selects a block. It does if it is the name of the block or, for a name that is a path
/// ("fluid/internalMesh"), the beginning or end of the path.
bool means_block(std::string_view name, std::string_view block);

/// Whether any name of the choice selects the block, or the choice is empty.
bool is_chosen(const BlockChoice& choice, std::string_view block);

/// Throws Error(bad_input) for a name that does not select any block of a file. The message lists the existing blocks
/// and the nearest match; with `with_surfaces` it lists all blocks, because `info` lists only some of the surfaces.
void require_blocks(const BlockChoice& choice, std::span<const std::string> blocks, const std::string& source,
                    bool with_surfaces = false);

/// Returns a note for `info` about surfaces in a file that also has a volume, with their number and the first twenty
/// names. `what` names their kind ("side set").
std::string note_on_surfaces(std::string_view what, std::span<const std::string> names);

/// Returns the names in their order, without empty names and duplicates.
std::vector<std::string> distinct_names(std::vector<std::string> names);

}  // namespace tessera::cells
