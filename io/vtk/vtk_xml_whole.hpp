// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/vtk/vtk_xml_arrays.hpp"
#include "io/vtk/vtk_xml_grid.hpp"
#include "io/vtk/vtk_xml_numbers.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {

/// An array of all pieces, one after the other.
struct VtkXmlWhole {
  std::vector<VtkXmlSegment> segments;
  int components = 1;
  bool has_ghost_levels = false;  ///< of old files, which become bits of vtkGhostType
};

/// What of an open file its arrays need.
struct VtkXmlOpened {
  std::shared_ptr<const system::PositionalFile> file;
  const VtkXmlGrid& grid;
  const std::string& source;
  std::shared_ptr<VtkXmlArrays> arrays;
};

/// Bytes of an array, decoded; empty until they have been read.
using VtkXmlDecoded = std::vector<std::byte>;

/// Makes a whole array readable, of the type, name and mark of `as`: from `decoded`, if that has been filled by the
/// time, else from the file. Throws Error(bad_input) if the file cannot have so many numbers.
ForeignArray hold_whole(const VtkXmlOpened& of, VtkXmlWhole whole, ForeignArray as,
                        std::shared_ptr<const VtkXmlDecoded> decoded = {});

/// The fields of points or of cells.
struct VtkXmlFieldsOf {
  VtkXmlFields VtkXmlPiece::*fields;
  std::uint64_t VtkXmlPiece::*count;
};
inline constexpr VtkXmlFieldsOf fields_of_points{&VtkXmlPiece::point_fields, &VtkXmlPiece::points};
inline constexpr VtkXmlFieldsOf fields_of_cells{&VtkXmlPiece::cell_fields, &VtkXmlPiece::cells};

/// Whether all pieces that are not empty have the same fields. VTK's reader takes those of the first piece, and leaves
/// what others lack as memory happened to be.
bool fields_agree(const VtkXmlGrid& grid, const VtkXmlFieldsOf& kind);

/// The fields but for those of text, each read once for its tally, on several threads. Throws Error(bad_input) for a
/// damaged one.
std::vector<ForeignArray> hold_fields(const VtkXmlOpened& of, const VtkXmlFieldsOf& kind);

}  // namespace tessera::io
