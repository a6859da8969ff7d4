// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh/tecplot_header.hpp"

namespace tessera::io {

/// The numbers that are stored in a zone itself. Arrays that the zone shares from other zones are empty.
struct TecplotNumbers {
  std::vector<std::vector<double>> values;                       ///< per variable, for each node or element
  std::vector<std::size_t> connectivity;                         ///< node numbers, counted from 1: 4 or 8 per element
  std::vector<std::size_t> face_sizes, face_nodes, left, right;  ///< faces of polyhedra; numbers from 1, and 0 means
                                                                 ///< none
};

/// Reads a zone's numbers. Throws Error(bad_input) with file, line and remedy.
TecplotNumbers read_tecplot_numbers(std::string_view text, const TecplotZone& zone, const std::string& source);

}  // namespace tessera::io
