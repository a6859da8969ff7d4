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

/// The contents of a Tecplot text file at one time step: one block per zone of cells, with a field for each variable
/// except the coordinates.
struct TecplotMesh {
  std::vector<cells::CellBlock> blocks;
  std::vector<std::string> notes;
  scene::TimeStepRead time_step{};
};

/// Parses a Tecplot text file: ordered zones, bricks, tetrahedra and polyhedra, with values by points or in blocks, at
/// nodes or cells, shared between zones or not. If zones have different solution times, each of these is a time step,
/// and the last step is read by default; zones without a strand belong to all steps. Coordinates are the variables
/// named X, Y and Z, or the first three. Zones of lines and faces are left out with a note. Throws Error(bad_input)
/// with file, line and remedy. Memory is proportional to the text.
///
/// Source  Tecplot, Inc., "Data Format Guide", chapter "ASCII Data".
TecplotMesh parse_tecplot(std::string_view text, const std::string& source, std::optional<std::size_t> time_step);

}  // namespace tessera::io
