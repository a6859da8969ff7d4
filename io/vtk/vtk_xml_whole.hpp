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

/// An array of the whole file: the arrays of its pieces that have the same name and type, concatenated.
struct VtkXmlWhole {
  std::vector<VtkXmlSegment> segments;
  int components = 1;
  bool has_ghost_levels = false;  ///< the array is vtkGhostLevels of old files; its values become bits of vtkGhostType
};

/// What is needed to read the arrays of an open file.
struct VtkXmlOpened {
  std::shared_ptr<const system::PositionalFile> file;
  const VtkXmlGrid& grid;
  const std::string& source;
  std::shared_ptr<VtkXmlArrays> arrays;
};

/// Decoded bytes of an array; empty until they have been read.
using VtkXmlDecoded = std::vector<std::byte>;

/// Makes a whole array readable, with the type, name and marks of `as`. The numbers are read from `decoded` if that is
/// filled when they are requested, otherwise from the file. Throws Error(bad_input) if the file is too small for the
/// array.
ForeignArray hold_whole(const VtkXmlOpened& of, VtkXmlWhole whole, ForeignArray as,
                        std::shared_ptr<const VtkXmlDecoded> decoded = {});

/// The arrays of points or of cells.
struct VtkXmlFieldsOf {
  VtkXmlFields VtkXmlPiece::*fields;
  std::uint64_t VtkXmlPiece::*count;
};
inline constexpr VtkXmlFieldsOf fields_of_points{&VtkXmlPiece::point_fields, &VtkXmlPiece::points};
inline constexpr VtkXmlFieldsOf fields_of_cells{&VtkXmlPiece::cell_fields, &VtkXmlPiece::cells};

/// Whether all non-empty pieces have the same fields. Needed because VTK's reader uses the fields of the first piece
/// and leaves values that other pieces lack uninitialized.
bool fields_agree(const VtkXmlGrid& grid, const VtkXmlFieldsOf& kind);

/// Adds all fields except text arrays. Each is read once to compute its tally, on several threads. Throws
/// Error(bad_input) for a damaged field.
std::vector<ForeignArray> hold_fields(const VtkXmlOpened& of, const VtkXmlFieldsOf& kind);

}  // namespace tessera::io
