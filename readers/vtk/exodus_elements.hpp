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

/// A block's topology in upper case: "HEX", "HEX20", "TETRA", ...
std::string exodus_topology(const ex_block& info);

/// The elements of a block. Solids with nodes that no supported type has are drawn by their corners.
struct ExodusElement {
  std::optional<CellType> type{};           ///< `quad` for all non-solids, no value for unknown elements
  const cells::NodeOrder* order = nullptr;  ///< null unless it is a solid of the table
};

/// Identified by the first letters of its topology and the number of nodes, which names may omit.
ExodusElement exodus_element(const std::string& topology, std::int64_t nodes);

/// The corners of a solid's side (counted from 1, as in the manual), as indices in the element from 0; empty for other
/// topologies, and for sides that do not exist.
std::span<const std::uint8_t> exodus_side(const std::string& topology, std::int64_t side);

/// For a block with its points, whose tetrahedra of 15 nodes and wedges of 21 are in the manual's order: if all of one
/// kind fit better in the order of the library's side sets or of Ioss, they are reordered to that.
void settle_exodus_middles(cells::CellBlock& block);

}  // namespace tessera::readers
