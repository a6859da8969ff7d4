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
  std::string name;                ///< `array NUMBER`, from 1, where the file has none
  std::optional<NumberType> type;  ///< none: text, or tuples of no numbers
  int components = 1;
  bool are_bits = false;  ///< eight in a byte, the first highest, but in text; to others they are of uint8
  bool ascii = false;
  VtkArrayPlace place{};  ///< of ascii numbers the first byte and the end alone

  /// Whether numbers of both are read alike, and have one meaning.
  [[nodiscard]] bool is_like(const VtkXmlArray& other) const {
    return name == other.name && type == other.type && components == other.components;
  }
};

/// The arrays of a piece's points or cells.
struct VtkXmlFields {
  std::vector<VtkXmlArray> arrays;
  std::string scalars, vectors;  ///< the names of the active ones
  std::string global_ids, pedigree_ids;
};

/// One <Piece>: what it has of each kind, numbers not read yet.
struct VtkXmlPiece {
  std::uint64_t points = 0, cells = 0;   ///< of unstructured grids
  std::string extent;                    ///< of the others
  std::vector<VtkXmlArray> coordinates;  ///< in <Points> or <Coordinates>
  std::vector<VtkXmlArray> topology;     ///< in <Cells>
  VtkXmlFields point_fields, cell_fields;

  /// An array of <Cells>; null if there is none.
  [[nodiscard]] const VtkXmlArray* find(const std::string& name) const;
};

/// A VTK XML file of one data set, without its numbers.
struct VtkXmlGrid {
  int major = 0, minor = 0;  ///< version of the format; 0 if the file does not state it
  VtkXmlElement element;     ///< that of the data set
  std::vector<VtkXmlPiece> pieces;
};

/// Nothing if the file has what this reader does not know: time steps, two arrays of one name, numbers between
/// comments, a version or type to come. Throws Error(bad_input) of `source` if it is another kind of file, or damaged.
std::optional<VtkXmlGrid> read_vtk_xml_grid(const system::PositionalFile& file, const std::string& source);

/// A type of numbers as VTK XML files name it, and the type that is named so.
const char* vtk_xml_type_name(NumberType type);
std::optional<NumberType> vtk_xml_number_type(const std::string& name);

/// The one whole number that a text is, among blanks; false: it is something else.
bool read_whole_number(const std::string& text, std::int64_t& number);

}  // namespace tessera::io
