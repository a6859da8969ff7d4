// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/foreign/messages/foreign_data.hpp"
#include "io/vtk/vtk_array.hpp"
#include "io/vtk/vtk_xml_elements.hpp"

namespace tessera::io {

/// An array as a VTK XML file declares it.
struct VtkXmlArray {
  std::string name;                ///< `array NUMBER`, counted from 1, if the file does not name the array
  std::optional<NumberType> type;  ///< type of the numbers; no value for text and for tuples without components
  int components = 1;
  /// Numbers of one bit. A byte of the file contains eight of them, the first in the highest bit (except in ascii
  /// arrays). Other code uses one uint8 per number.
  bool are_bits = false;
  bool ascii = false;
  VtkArrayPlace place{};  ///< for ascii numbers only the first byte and the end are set

  /// Whether both arrays have the same meaning and are read the same way.
  [[nodiscard]] bool is_like(const VtkXmlArray& other) const {
    return name == other.name && type == other.type && components == other.components;
  }
};

/// The arrays of a piece's points or cells.
struct VtkXmlFields {
  std::vector<VtkXmlArray> arrays;
  std::string scalars, vectors;  ///< the names of the active arrays
  std::string global_ids, pedigree_ids;
};

/// One <Piece>: its arrays of each kind, without their values.
struct VtkXmlPiece {
  std::uint64_t points = 0, cells = 0;   ///< counts, for an unstructured grid
  std::string extent;                    ///< for the other grids
  std::vector<VtkXmlArray> coordinates;  ///< arrays in <Points> or <Coordinates>
  std::vector<VtkXmlArray> topology;     ///< in <Cells>
  VtkXmlFields point_fields, cell_fields;

  /// Returns an array of <Cells>; null if there is none of this name.
  [[nodiscard]] const VtkXmlArray* find(const std::string& name) const;
};

/// A VTK XML file of one data set, without its numbers.
struct VtkXmlGrid {
  int major = 0, minor = 0;  ///< version of the format; 0 if the file does not state it
  VtkXmlElement element;     ///< the element of the data set
  std::vector<VtkXmlPiece> pieces;
};

/// Returns the description of a file. No value if the file has unsupported features: time steps, two arrays of one
/// name, comments between numbers, a later version, or another type. Throws Error(bad_input) naming `source` if it is
/// another kind of file, or damaged.
std::optional<VtkXmlGrid> read_vtk_xml_grid(const system::PositionalFile& file, const std::string& source);

/// Returns the name of a number type in VTK XML files. vtk_xml_number_type() is the inverse.
const char* vtk_xml_type_name(NumberType type);
std::optional<NumberType> vtk_xml_number_type(const std::string& name);

/// Parses a text that is one integer, surrounded by blanks; false if it is anything else.
bool read_whole_number(const std::string& text, std::int64_t& number);

}  // namespace tessera::io
