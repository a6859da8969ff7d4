// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "cells/cell_block.hpp"
#include "cells/surface.hpp"

namespace tessera::io {

/// Parses a .node and a .ele file into a block of linear or second-order tets. Attributes of points and of cells become
/// the fields "attribute0", ...; markers become the point field "marker". The number of the first point, 0 or 1,
/// determines where numbers start. Allocates nothing before the text is known to be long enough. Throws
/// Error(bad_input) with file, line and remedy.
cells::CellBlock parse_node_ele(std::string_view node, std::string_view ele, const std::string& node_source,
                                const std::string& ele_source);

/// Parses a .poly or .smesh file. `node` is the text of the matching .node file, which is used if the file's point list
/// has 0 points. Throws like parse_node_ele().
cells::Surface parse_tetgen_surface(std::string_view text, bool smesh, std::string_view node, const std::string& source,
                                    const std::string& node_source);

}  // namespace tessera::io
