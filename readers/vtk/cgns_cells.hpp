// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"
#include "readers/vtk/cgns_library.hpp"

namespace tessera::readers {

/// An unstructured or structured zone of an open CGNS file. Numbers count from 1, as in the library.
struct CgnsZone {
  int file = 0, base = 0, zone = 0;
  std::string name{};   ///< base and zone, "BASE/ZONE"
  std::string where{};  ///< for messages: file and name
  CGNS_ENUMT(ZoneType_t) type{};
  int dimensions = 3;              ///< of its cells
  std::array<cgsize_t, 9> size{};  ///< points, then cells, along each index

  [[nodiscard]] bool is_structured() const { return type == CGNS_ENUMV(Structured); }
};

/// Throws Error(bad_input) with the library's message if `status` is an error.
void require_cgns(int status, const CgnsZone& zone);

/// Whether VTK's reader identifies the cells of an unstructured zone correctly. It takes the elements with the first
/// numbers, as many as the zone has cells, in the order of the sections. Elements of order 2 are never plain.
bool is_plain(const CgnsZone& zone);

/// Sets the cells of an unstructured zone: three-dimensional elements in the order of their numbers, whatever the order
/// of the sections and the numbers of faces among them. Polyhedra are NFACE_n or, without these, the parents of faces.
///
/// Source  CGNS Standard Interface Data Structures, "Grid Coordinates, Elements, and Flow Solutions": 7.3, Elements_t,
///         and its figures of the elements' nodes.
void set_cells(const CgnsZone& zone, cells::CellBlock& block);

}  // namespace tessera::readers
