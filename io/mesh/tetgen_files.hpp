// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "cells/cell_block.hpp"
#include "cells/surface.hpp"

namespace tessera::io {

/// The text of a .node and a .ele file as a block of (linear or second-order) tets. Attributes become the fields
/// "attribute0", ... of points and of cells, markers the point field "marker". Numbering from 0 or 1 as the first line
/// of points has it. Nothing is allocated before the text is long enough to hold it. Throws Error(bad_input) with file,
/// line and remedy.
cells::CellBlock parse_node_ele(std::string_view node, std::string_view ele, const std::string& node_source,
                                const std::string& ele_source);

/// The text of a .poly or .smesh file; `node` is that of the .node file beside it, used where the point list has 0
/// points. Throws as above.
cells::Surface parse_tetgen_surface(std::string_view text, bool smesh, std::string_view node, const std::string& source,
                                    const std::string& node_source);

}  // namespace tessera::io
