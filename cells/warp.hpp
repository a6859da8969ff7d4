// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "cells/mesh_blocks.hpp"
#include "tessera/warp.hpp"

namespace tessera::cells {

/// Whether the name of a vector denotes a displacement, in upper or lower case: "dis", "disp", "displ", "displacement",
/// optionally with "s" or "_" at the end. VTK's reader accepts any name that begins with "dis", even "dissipation" and
/// "distance".
bool is_displacement_name(const std::string& name);

/// Moves the points of the blocks as requested (ReadOptions::warp). Without a request, points of Exodus files move by
/// the first vector with a displacement name, with a note. Blocks without the vector do not move. Throws
/// Error(bad_input) that lists the vectors if no block has the requested one.
void warp(MeshBlocks& read, const std::optional<Warp>& request, const std::string& source);

}  // namespace tessera::cells
