// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtk_xml_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <string_view>
#include <utility>

#include "scene/error.hpp"
#include "system/positional_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

constexpr int newest_major = 2;
constexpr std::int64_t most_components = 1 << 20;
constexpr std::uint64_t most_tuples = 1ull << 40;  // limit, so that byte counts do not overflow

/// Thrown for features that this reader does not support.
struct Unknown {};

/// Encoding shared by all arrays of a file.
struct Packing {
  VtkArrayPlace place;                         ///< encoding of an array; the position is not set
  std::optional<std::uint64_t> appended_at{};  ///< position after the underscore
  bool appended_base64 = false;
};

std::uint64_t count_of(const VtkXmlElement& piece, const std::string& attribute, std::size_t number,
                       const std::string& source) {
  std::int64_t count = -1;
  if (!read_whole_number(piece.word(attribute), count) || count < 0 || static_cast<std::uint64_t>(count) > most_tuples)
    throw scene::bad_input(
        fmt::format("{}: the {} of piece {} is {}, which is not a valid count; the file may be damaged", source,
                    attribute, number, quote(piece.word(attribute))));
  return static_cast<std::uint64_t>(count);
}

Packing packing_of(const VtkXmlElement& root, const std::vector<VtkXmlElement>& elements,
                   const system::PositionalFile& file) {
  Packing packing;
  const std::string order = root.word("byte_order", "LittleEndian"), number = root.word("header_type", "UInt32");
  const auto codec = vtk_codec_named(root.word("compressor"));
  if ((order != "LittleEndian" && order != "BigEndian") || (number != "UInt32" && number != "UInt64") || !codec)
    throw Unknown();
  packing.place.codec = *codec;
  packing.place.swapped = order == "BigEndian";
  packing.place.number_bytes = number == "UInt64" ? 8 : 4;
  const VtkXmlElement& last = elements.back();
  if (last.name != "AppendedData") return packing;
  packing.appended_base64 = last.word("encoding") != "raw";
  std::array<char, 256> beginning{};
  const std::uint64_t there = std::min<std::uint64_t>(beginning.size(), file.size() - last.text_at);
  file.read(last.text_at, reinterpret_cast<std::byte*>(beginning.data()), there);
  const std::string_view text(beginning.data(), there);
  const std::size_t mark = text.find_first_not_of(" \n\r\t");
  if (mark == std::string_view::npos || text[mark] != '_') throw Unknown();
  packing.appended_at = last.text_at + mark + 1;
  return packing;
}

VtkXmlArray array_of(const VtkXmlElement& element, const Packing& packing) {
  if ((element.name != "DataArray" && element.name != "Array") || element.has("TimeStep")) throw Unknown();
  VtkXmlArray array;
  array.name = element.word("Name");
  const std::string type = element.word("type");
  array.are_bits = type == "Bit";
  array.type = array.are_bits ? NumberType::uint8 : vtk_xml_number_type(type);
  if (!array.type && type != "String") throw Unknown();
  std::int64_t components = 1;
  if (element.has("NumberOfComponents") && (!read_whole_number(element.word("NumberOfComponents"), components) ||
                                            components < 0 || components > most_components))
    throw Unknown();
  if (components == 0) array.type.reset();
  array.components = static_cast<int>(components);
  array.place = packing.place;
  if (!element.has("offset")) {
    if (element.has_text_behind_tags) throw Unknown();
    array.ascii = element.word("format") != "binary";
    array.place.base64 = true;
    array.place.first_byte = element.text_at;
    array.place.end = element.text_end;
    return array;
  }
  std::int64_t offset = 0;
  if (!read_whole_number(element.word("offset"), offset) || !packing.appended_at) throw Unknown();
  array.place.base64 = packing.appended_base64;
  // A position before the beginning of the file wraps to a position far beyond its end.
  if (__builtin_add_overflow(*packing.appended_at, static_cast<std::uint64_t>(offset), &array.place.first_byte))
    array.place.first_byte = array.place.end;
  return array;
}

/// Interprets the elements in order. If a piece has two elements of a kind, the second replaces the first.
class GridElements {
 public:
  GridElements(const std::vector<VtkXmlElement>& elements, const system::PositionalFile& file,
               const std::string& source)
      : elements_(elements), packing_(packing_of(elements.front(), elements, file)), source_(source) {}

  VtkXmlGrid grid() {
    const VtkXmlElement& root = elements_.front();
    read_version(root.word("version"));
    std::size_t at = 1;
    while (at < elements_.size() && !(elements_[at].depth == 1 && elements_[at].name == root.word("type"))) ++at;
    if (at == elements_.size())
      throw scene::bad_input(
          fmt::format("{}: it has no element {}; the file may be damaged", source_, quote(root.word("type"))));
    grid_.element = elements_[at];
    if (grid_.element.has("TimeValues")) throw Unknown();
    for (++at; at < elements_.size() && elements_[at].depth > 1; ++at) {
      const VtkXmlElement& element = elements_[at];
      if (element.depth == 2 && element.name == "Piece") add_piece(element);
      if (grid_.pieces.empty()) continue;
      if (element.depth == 2) in_piece_ = element.name == "Piece";
      if (element.depth == 3 && in_piece_) begin_list(element);
      if (element.depth == 4 && list_ != nullptr && in_piece_) list_->push_back(array_of(element, packing_));
    }
    if (grid_.pieces.empty()) throw Unknown();
    for (VtkXmlPiece& piece : grid_.pieces)
      for (VtkXmlFields* fields : {&piece.point_fields, &piece.cell_fields}) name_all(*fields);
    return std::move(grid_);
  }

 private:
  /// Parses "MAJOR.MINOR", which is absent in old files.
  void read_version(const std::string& version) {
    const char *at = version.data(), *const end = at + version.size();
    const auto major = std::from_chars(at, end, grid_.major);
    if (major.ec == std::errc() && major.ptr < end) static_cast<void>(std::from_chars(major.ptr + 1, end, grid_.minor));
    if (grid_.major > newest_major) throw Unknown();
  }

  void add_piece(const VtkXmlElement& element) {
    VtkXmlPiece piece;
    list_ = nullptr;
    if (grid_.element.name == "UnstructuredGrid") {
      piece.points = count_of(element, "NumberOfPoints", grid_.pieces.size(), source_);
      piece.cells = count_of(element, "NumberOfCells", grid_.pieces.size(), source_);
    }
    piece.extent = element.word("Extent");
    grid_.pieces.push_back(std::move(piece));
  }

  void begin_list(const VtkXmlElement& element) {
    VtkXmlPiece& piece = grid_.pieces.back();
    const auto fields = [&](VtkXmlFields& of) {
      of = {
          {}, element.word("Scalars"), element.word("Vectors"), element.word("GlobalIds"), element.word("PedigreeIds")};
      return &of.arrays;
    };
    list_ = element.name == "PointData"                                 ? fields(piece.point_fields)
            : element.name == "CellData"                                ? fields(piece.cell_fields)
            : element.name == "Points" || element.name == "Coordinates" ? &piece.coordinates
            : element.name == "Cells"                                   ? &piece.topology
                                                                        : nullptr;
    if (list_ != nullptr) list_->clear();
  }

  /// Names arrays that have no name, because VTK's reader stops at them. Throws Unknown if two arrays have one name.
  static void name_all(VtkXmlFields& fields) {
    std::set<std::string> names;
    std::size_t number = 0;
    for (VtkXmlArray& array : fields.arrays) {
      ++number;
      if (array.name.empty()) array.name = fmt::format("array {}", number);
      if (!names.insert(array.name).second) throw Unknown();
    }
  }

  const std::vector<VtkXmlElement>& elements_;
  Packing packing_;
  const std::string& source_;
  VtkXmlGrid grid_;
  std::vector<VtkXmlArray>* list_ = nullptr;  ///< receives the arrays of the piece
  bool in_piece_ = false;
};

}  // namespace

const VtkXmlArray* VtkXmlPiece::find(const std::string& name) const {
  const auto found = std::ranges::find(topology, name, &VtkXmlArray::name);
  return found == topology.end() ? nullptr : &*found;
}

const char* vtk_xml_type_name(NumberType type) {
  static constexpr std::array names = {"Int8",   "UInt8", "Int16",  "UInt16",  "Int32",
                                       "UInt32", "Int64", "UInt64", "Float32", "Float64"};
  return names[static_cast<std::size_t>(type)];
}

std::optional<NumberType> vtk_xml_number_type(const std::string& name) {
  for (int type = 0; type <= static_cast<int>(NumberType::float64); ++type)
    if (name == vtk_xml_type_name(static_cast<NumberType>(type))) return static_cast<NumberType>(type);
  return std::nullopt;
}

bool read_whole_number(const std::string& text, std::int64_t& number) {
  const auto found = number_of<std::int64_t>(trimmed(text));
  number = found.value_or(number);
  return found.has_value();
}

std::optional<VtkXmlGrid> read_vtk_xml_grid(const system::PositionalFile& file, const std::string& source) {
  const std::vector<VtkXmlElement> elements = vtk_xml_elements(file, source);
  if (elements.empty() || elements.front().name != "VTKFile")
    throw scene::bad_input(fmt::format("{}: it does not begin like a VTK XML file; check that it is one", source));
  try {
    return GridElements(elements, file, source).grid();
  } catch (const Unknown&) {
    return std::nullopt;
  }
}

}  // namespace tessera::io
