// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::cells {

/// Blocks of a file by name, as given by a caller; empty: all.
using BlockChoice = std::vector<std::string>;

/// Whether a name selects a block: it is the block's name or, if that is a path of names ("fluid/internalMesh"), its
/// beginning or end.
bool means_block(std::string_view name, std::string_view block);

/// Whether any name of the choice selects the block, or the choice is empty.
bool is_chosen(const BlockChoice& choice, std::string_view block);

/// Throws Error(bad_input) for a name that selects none of a file's blocks, listing the existing ones and the nearest
/// match; with `with_surfaces`, listing all of them, because `info` lists only some surfaces.
void require_blocks(const BlockChoice& choice, std::span<const std::string> blocks, const std::string& source,
                    bool with_surfaces = false);

/// A note for `info` about surfaces in a file that also has a volume; `what` names their kind ("side set"). It has
/// their number and the first twenty names.
std::string note_on_surfaces(std::string_view what, std::span<const std::string> names);

/// The names in their order, without empty ones and duplicates.
std::vector<std::string> distinct_names(std::vector<std::string> names);

}  // namespace tessera::cells
