// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"
#include "readers/vtk/cgns_library.hpp"

namespace tessera::readers {

/// An unstructured or structured zone of an open CGNS file. Numbers are counted from 1, as in the CGNS library.
struct CgnsZone {
  int file = 0, base = 0, zone = 0;
  std::string name{};   ///< names of base and zone, "BASE/ZONE"
  std::string where{};  ///< file and name, for messages
  CGNS_ENUMT(ZoneType_t) type{};
  int dimensions = 3;              ///< dimension of the zone's cells
  std::array<cgsize_t, 9> size{};  ///< numbers of points, then of cells, along each index

  [[nodiscard]] bool is_structured() const { return type == CGNS_ENUMV(Structured); }
};

/// Throws Error(bad_input) with the library's message if `status` is an error.
void require_cgns(int status, const CgnsZone& zone);

/// Whether VTK's reader identifies the cells of an unstructured zone correctly. It reads the elements with the lowest
/// numbers, as many as the zone has cells, in the order of the sections. False for any zone with elements of order 2.
bool is_plain(const CgnsZone& zone);

/// Sets the cells of an unstructured zone: its three-dimensional elements in the order of their numbers, whatever the
/// order of the sections, and even if faces have numbers between them. Polyhedra are defined by NFACE_n or, if that is
/// absent, by the parents of faces.
///
/// Source  CGNS Standard Interface Data Structures, "Grid Coordinates, Elements, and Flow Solutions": 7.3, Elements_t,
///         and its figures of the elements' nodes.
void set_cells(const CgnsZone& zone, cells::CellBlock& block);

}  // namespace tessera::readers
