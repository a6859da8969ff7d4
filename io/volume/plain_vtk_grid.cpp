// SPDX-License-Identifier: BSD-3-Clause
// Regular and rectilinear grids with a single array, read in place. open_vtk_xml() and VTK's reader, which read all
// others (io/foreign/foreign_vtk_grids.cpp), hold all samples in memory.
#include "io/volume/plain_vtk_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <locale>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/foreign/client/foreign_geometry.hpp"
#include "io/text/scanner.hpp"
#include "io/text/xml_elements.hpp"
#include "io/volume/volume_formats.hpp"
#include "io/vtk/vtk_array.hpp"
#include "io/vtk/vtk_xml_grid.hpp"
#include "scene/byte_order.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {
namespace {

constexpr std::size_t longest_beginning = 1 << 20, longest_number = 32;

/// The XML text of a file: its beginning or, if the samples are within the text, the parts before and after the
/// samples.
struct GridWords {
  std::string text;
  std::size_t cut = std::string::npos;  ///< position in the text where samples are omitted
  std::uint64_t left_out = 0;           ///< bytes

  /// Position in the file of a position in the text.
  [[nodiscard]] std::uint64_t place(std::size_t at) const { return at < cut ? at : at + left_out; }
};

using Attributes = std::map<std::string, std::string>;

struct ElementFound {
  Attributes attributes;
  std::size_t text_at = 0;
};

struct GridElements {
  Attributes file, grid, piece;
  ElementFound samples, appended;
  std::vector<ElementFound> axes;
  int pieces = 0, arrays = 0, coordinates = 0;
  bool of_cells = false, active = false;
  bool whole = false;  ///< only appended arrays follow the text
};

struct WordsEnd {};

std::string word(const Attributes& attributes, const std::string& name, const std::string& otherwise = "") {
  const auto found = attributes.find(name);
  return found == attributes.end() ? otherwise : found->second;
}

/// Parses the elements up to the appended arrays or the end of the text.
GridElements elements_of(std::string_view words, const std::string& source) {
  GridElements found;
  std::string scalars;
  try {
    each_xml_element(words, source, [&](const XmlElement& element) {
      const std::string parent = element.parents.empty() ? "" : element.parents.back();
      const bool fields = element.name == "PointData" || element.name == "CellData";
      if (element.name == "VTKFile") found.file = element.attributes;
      if (element.name == word(found.file, "type")) found.grid = element.attributes;
      if (element.name == "Piece") found.piece = element.attributes, ++found.pieces;
      if (fields) scalars = element.find("Scalars") != nullptr ? *element.find("Scalars") : "";
      if (element.name == "DataArray" && (parent == "PointData" || parent == "CellData")) {
        found.samples = {element.attributes, element.text_at};
        found.of_cells = parent == "CellData", ++found.arrays;
        found.active = element.find("Name") != nullptr && *element.find("Name") == scalars;
      }
      if (element.name == "Coordinates") ++found.coordinates;
      if (parent == "Coordinates" && found.axes.size() < 4) found.axes.push_back({element.attributes, element.text_at});
      if (element.name == "AppendedData") {
        found.appended = {element.attributes, element.text_at};
        throw WordsEnd();
      }
    });
    found.whole = true;
  } catch (const WordsEnd&) {
    found.whole = true;
  } catch (const scene::Error&) {  // the XML continues after this text; the elements parsed so far must be sufficient
  }
  return found;
}

template <class T, std::size_t n>
bool read_numbers(const std::string& text, std::array<T, n>& numbers) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  for (T& number : numbers)
    if (!(in >> number)) return false;
  return (in >> std::ws).eof();
}

/// Returns false if the extent has any unusual feature.
bool set_extent(const GridElements& found, ForeignPart& part, scene::GridGeometry& g) {
  std::array<std::int64_t, 6> piece{};
  if (!read_numbers(word(found.grid, "WholeExtent"), part.extent) ||
      !read_numbers(word(found.piece, "Extent"), piece) || piece != part.extent)
    return false;
  for (std::size_t a = 0; a < 3; ++a) {
    constexpr std::int64_t most = 1 << 16;  // limit, so that byte counts do not overflow
    const std::int64_t low = part.extent[2 * a], high = part.extent[2 * a + 1];
    if (low < -most || high > most || high <= low) return false;
    g.points[a] = high - low + 1;
  }
  g.association = found.of_cells ? scene::Association::cell : scene::Association::point;
  return true;
}

bool set_image(const GridElements& found, ForeignPart& image, scene::GridGeometry& g) {
  if (!read_numbers(word(found.grid, "Origin", "0 0 0"), image.origin) ||
      !read_numbers(word(found.grid, "Spacing", "1 1 1"), image.spacing) ||
      !read_numbers(word(found.grid, "Direction", "1 0 0 0 1 0 0 0 1"), image.direction) ||
      !std::ranges::all_of(image.spacing, [](double step) { return step > 0; }))
    return false;
  set_image_geometry(image, g);
  return true;
}

/// Encoding shared by all arrays of a file.
VtkArrayPlace packing_of(const GridElements& found) {
  return {.codec = vtk_codec_named(word(found.file, "compressor")).value_or(VtkCodec::none),
          .swapped = word(found.file, "byte_order") == "BigEndian",
          .number_bytes = word(found.file, "header_type") == "UInt64" ? 8u : 4u};
}

/// Returns where a binary array begins; no value if it is outside the text.
std::optional<VtkArrayPlace> place_of(const ElementFound& array, const GridElements& found, const GridWords& words) {
  VtkArrayPlace place = packing_of(found);
  const std::string format = word(array.attributes, "format");
  if (format == "binary") {
    place.base64 = true;
    place.first_byte = words.place(array.text_at);
    return place;
  }
  constexpr std::uint64_t most = 1ull << 62;
  std::array<std::uint64_t, 1> offset{};
  const std::string encoding = word(found.appended.attributes, "encoding");
  const std::size_t mark = words.text.find('_', found.appended.text_at);
  if (format != "appended" || (encoding != "base64" && encoding != "raw") || mark == std::string::npos ||
      !read_numbers(word(array.attributes, "offset"), offset) || offset[0] > most)
    return std::nullopt;
  place.base64 = encoding == "base64";
  place.first_byte = words.place(mark) + 1 + offset[0];
  return place;
}

/// Parses exactly as many numbers as `numbers` has, each rounded to its type. Returns false for any other text.
bool read_text(std::string_view text, NumberType type, std::span<double> numbers) {
  return with_number_type(type, [&](auto value) {
    const std::string unnamed;
    TextScanner words(text, unnamed);
    for (double& number : numbers) {
      if (words.number(value) != Scanned::number) return false;
      number = static_cast<double>(value);
    }
    return words.at_end();
  });
}

/// Reads the coordinates of an axis. No value if the array has any unusual feature.
std::optional<AxisCoordinates> axis_of(const system::PositionalFile& file, const ElementFound& array,
                                       const GridElements& found, const GridWords& words, std::int64_t points) {
  const auto type = vtk_xml_number_type(word(array.attributes, "type"));
  if (!type || word(array.attributes, "NumberOfComponents", "1") != "1") return std::nullopt;
  AxisCoordinates axis{*type, std::vector<double>(static_cast<std::size_t>(points))};
  if (word(array.attributes, "format") == "ascii") {
    const std::string_view text = std::string_view(words.text).substr(array.text_at);
    if (!read_text(text.substr(0, text.find('<')), *type, axis.values)) return std::nullopt;
    return axis;
  }
  const auto place = place_of(array, found, words);
  auto bytes = place ? small_vtk_array(file, *place, axis.values.size() * size_of(*type)) : std::nullopt;
  if (!bytes) return std::nullopt;
  if (place->swapped) with_number_type(*type, [&](auto zero) { scene::swap_numbers<decltype(zero)>(*bytes); });
  read_tuples(*bytes, *type, 1, 0, 0, axis.values);
  return axis;
}

bool set_axes_of(const system::PositionalFile& file, const GridElements& found, const GridWords& words,
                 scene::GridGeometry& g) {
  std::array<AxisCoordinates, 3> axes;
  if (found.coordinates != 1 || found.axes.size() != axes.size()) return false;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    auto axis = axis_of(file, found.axes[a], found, words, g.points[a]);
    if (!axis) return false;
    axes[a] = std::move(*axis);
  }
  set_rectilinear_geometry(std::move(axes), g);
  return true;
}

/// Omits the samples, which end at `end`, from the text. Returns false if the text after them is too long.
bool leave_out(const system::PositionalFile& file, std::size_t samples, std::uint64_t end, const scene::GridGeometry& g,
               GridWords& words) {
  std::uint64_t most = longest_beginning;
  for (const std::int64_t n : g.points) most += longest_number * static_cast<std::uint64_t>(n);
  const std::uint64_t size = file.size();
  if (end > size || size - end > most) return false;
  words.text.resize(samples + (size - end));
  file.read(end, reinterpret_cast<std::byte*>(words.text.data() + samples), size - end);
  words.cut = samples;
  words.left_out = end - samples;
  return true;
}

/// Whether this reader supports everything before the samples.
bool is_plain(const GridElements& found, const std::string& kind) {
  const std::string order = word(found.file, "byte_order"), number = word(found.file, "header_type", "UInt32");
  const std::string compressor = word(found.file, "compressor"), name = word(found.samples.attributes, "Name");
  return (kind == "ImageData" || kind == "RectilinearGrid") && found.pieces == 1 && found.arrays == 1 &&
         (order == "LittleEndian" || order == "BigEndian") && (number == "UInt32" || number == "UInt64") &&
         vtk_codec_named(compressor) && !name.empty() && name != "vtkGhostType";
}

}  // namespace

std::optional<StoredVolume> read_plain_vtk_grid(const std::filesystem::path& path, std::uint64_t most_in_memory) {
  if (most_in_memory == std::numeric_limits<std::uint64_t>::max()) return std::nullopt;
  const system::PositionalFile file(path);
  GridWords words{file.beginning(longest_beginning)};
  GridElements found = elements_of(words.text, path.string());
  const std::string kind = word(found.file, "type");
  const auto type = vtk_xml_number_type(word(found.samples.attributes, "type"));
  const auto sample_type = type ? scene::sample_type_of(*type) : std::nullopt;
  std::array<int, 1> components{};
  if (!sample_type || !is_plain(found, kind) ||
      !read_numbers(word(found.samples.attributes, "NumberOfComponents", "1"), components) || components[0] < 1 ||
      components[0] > 64)
    return std::nullopt;
  StoredVolume volume;
  volume.number = *sample_type;
  scene::GridGeometry& g = volume.grid.geometry;
  ForeignPart part;
  const auto place = place_of(found.samples, found, words);
  if (!place || !set_extent(found, part, g)) return std::nullopt;
  const std::uint64_t count = static_cast<std::uint64_t>(g.all_samples().count()) *
                              static_cast<std::uint64_t>(components[0]) * scene::size_of(volume.number);
  if (count <= most_in_memory) return std::nullopt;
  const auto end = end_of_vtk_array(file, *place, count);
  if (!end) return std::nullopt;
  if (word(found.samples.attributes, "format") == "binary") {
    if (!leave_out(file, found.samples.text_at, *end, g, words)) return std::nullopt;
    found = elements_of(words.text, path.string());
  }
  if (!found.whole || !is_plain(found, kind)) return std::nullopt;
  if (!(kind == "ImageData" ? set_image(found, part, g) : set_axes_of(file, found, words, g))) return std::nullopt;
  volume.components = components[0];
  volume.swapped = place->swapped;
  volume.field = word(found.samples.attributes, "Name");
  volume.active = found.active;
  volume.format = g.rectilinear() ? "VTK XML (rectilinear grid)" : "VTK XML (image data)";
  volume.payload = path;
  volume.payload_size = file.size();
  if (place->base64 || place->codec != VtkCodec::none)
    volume.vtk_array = place;
  else
    volume.offset = place->first_byte + place->number_bytes;
  return volume;
}

}  // namespace tessera::io
