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

/// The same array of all pieces, concatenated.
struct VtkXmlWhole {
  std::vector<VtkXmlSegment> segments;
  int components = 1;
  bool has_ghost_levels = false;  ///< in old files; they become bits of vtkGhostType
};

/// What the arrays of an open file need to be read.
struct VtkXmlOpened {
  std::shared_ptr<const system::PositionalFile> file;
  const VtkXmlGrid& grid;
  const std::string& source;
  std::shared_ptr<VtkXmlArrays> arrays;
};

/// Decoded bytes of an array; empty until they have been read.
using VtkXmlDecoded = std::vector<std::byte>;

/// Makes a whole array readable, with the type, name and marks of `as`: from `decoded` if that is filled by then, else
/// from the file. Throws Error(bad_input) if the file is too small for its numbers.
ForeignArray hold_whole(const VtkXmlOpened& of, VtkXmlWhole whole, ForeignArray as,
                        std::shared_ptr<const VtkXmlDecoded> decoded = {});

/// The arrays of points or of cells.
struct VtkXmlFieldsOf {
  VtkXmlFields VtkXmlPiece::*fields;
  std::uint64_t VtkXmlPiece::*count;
};
inline constexpr VtkXmlFieldsOf fields_of_points{&VtkXmlPiece::point_fields, &VtkXmlPiece::points};
inline constexpr VtkXmlFieldsOf fields_of_cells{&VtkXmlPiece::cell_fields, &VtkXmlPiece::cells};

/// Whether all non-empty pieces have the same fields. VTK's reader uses those of the first piece and leaves values that
/// other pieces lack uninitialized.
bool fields_agree(const VtkXmlGrid& grid, const VtkXmlFieldsOf& kind);

/// The fields except text arrays, each read once for its tally, on several threads. Throws Error(bad_input) for a
/// damaged one.
std::vector<ForeignArray> hold_fields(const VtkXmlOpened& of, const VtkXmlFieldsOf& kind);

}  // namespace tessera::io
