// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::cells {

/// Blocks of a file by name, as a caller gives them; none: all.
using BlockChoice = std::vector<std::string>;

/// Whether a name means a block: it is the block's, or where that is a path of names ("fluid/internalMesh"), its
/// beginning or end.
bool means_block(std::string_view name, std::string_view block);

/// Whether some name of the choice means the block, or there is no choice.
bool is_chosen(const BlockChoice& choice, std::string_view block);

/// Throws Error(bad_input) for a name that means none of a file's blocks, with those that there are and the nearest;
/// `with_surfaces`: with all of them, for `info` lists few surfaces.
void require_blocks(const BlockChoice& choice, std::span<const std::string> blocks, const std::string& source,
                    bool with_surfaces = false);

/// A note for `info` on parts of a file that are surfaces beside its volume, `what` of them ("side set"): how many
/// there are, and the first twenty names.
std::string note_on_surfaces(std::string_view what, std::span<const std::string> names);

/// The names without empty ones and repetitions, in their order.
std::vector<std::string> distinct_names(std::vector<std::string> names);

}  // namespace tessera::cells
