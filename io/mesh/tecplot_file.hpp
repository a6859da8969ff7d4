// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cells/cell_block.hpp"
#include "scene/time_step_read.hpp"

namespace tessera::io {

/// What a Tecplot text file holds at one time step: a block a zone of cells, with a field for each variable but the
/// coordinates.
struct TecplotMesh {
  std::vector<cells::CellBlock> blocks;
  std::vector<std::string> notes;
  scene::TimeStepRead time_step{};
};

/// Parses a Tecplot text file: ordered zones, bricks, tetrahedra and polyhedra, their values by points or in blocks, at
/// nodes or cells, shared between zones or not. Where zones have different solution times these are the steps, the last
/// by default; zones of no strand are of all steps. Coordinates are the variables named X, Y and Z, or the first three.
/// Zones of lines and faces are left out with a note. Throws Error(bad_input) with file, line and remedy. Memory is in
/// proportion to the text.
///
/// Source  Tecplot, Inc., "Data Format Guide", chapter "ASCII Data".
TecplotMesh parse_tecplot(std::string_view text, const std::string& source, std::optional<std::size_t> time_step);

}  // namespace tessera::io
