// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtk_exodusII.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "cells/cell_block.hpp"
#include "cells/curved/node_orders.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::readers {

/// Returns the topology of a block in upper case: "HEX", "HEX20", "TETRA", ...
std::string exodus_topology(const ex_block& info);

/// The type of a block's elements. If no supported type has the number of nodes of a solid, its corners are drawn.
struct ExodusElement {
  std::optional<CellType> type{};           ///< `quad` for all non-solids; no value for unknown elements
  const cells::NodeOrder* order = nullptr;  ///< null unless the element is a solid in the table of node orders
};

/// Identifies elements by the first letters of their topology and their number of nodes, which names may omit.
ExodusElement exodus_element(const std::string& topology, std::int64_t nodes);

/// Returns the corners of a side of a solid, as indices from 0 in the element. Sides are counted from 1, as in the
/// manual. Empty for other topologies, and for sides that do not exist.
std::span<const std::uint8_t> exodus_side(const std::string& topology, std::int64_t side);

/// Corrects the order of middle nodes. `block` must have points; its tetrahedra of 15 nodes and wedges of 21 nodes are
/// read as if they had the order of the manual. Some programs write the order of the library's side sets or of Ioss. If
/// one of these orders fits all cells of a kind better, the nodes of these cells are moved from that order to the order
/// of the manual.
void settle_exodus_middles(cells::CellBlock& block);

}  // namespace tessera::readers
