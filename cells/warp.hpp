// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "cells/mesh_blocks.hpp"
#include "tessera/read_options.hpp"

namespace tessera::cells {

/// Whether a vector by its name says how far nodes have moved, whatever the letters' case: "dis", "disp", "displ",
/// "displacement", with or without an "s" or a "_" at the end. VTK's reader takes any name that begins with "dis", so
/// "dissipation" and "distance" too.
bool is_displacement_name(const std::string& name);

/// Moves the points of the blocks as the options say, without a wish those of Exodus files by the first vector with the
/// name of a displacement, and notes it. Blocks without the vector stay. Throws Error(bad_input) that lists the vectors
/// if no block has the one that is asked for.
void warp(MeshBlocks& read, const ReadOptions& options, const std::string& source);

}  // namespace tessera::cells
