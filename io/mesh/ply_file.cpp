// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/ply_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "io/text/scanner.hpp"
#include "scene/byte_order.hpp"
#include "scene/error.hpp"
#include "scene/number_type.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

using scene::NumberType;

constexpr scene::NumberTypeNames ply_types[] = {
    {NumberType::int8, "char,int8"},        {NumberType::uint8, "uchar,uint8"},     {NumberType::int16, "short,int16"},
    {NumberType::uint16, "ushort,uint16"},  {NumberType::int32, "int,int32"},       {NumberType::uint32, "uint,uint32"},
    {NumberType::float32, "float,float32"}, {NumberType::float64, "double,float64"}};

struct Property {
  std::string name;
  NumberType type = NumberType::float32;
  std::optional<NumberType> count;  ///< type of the length, if the property is a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

/// Colours, normals and texture coordinates describe the appearance of the surface, not a quantity on it.
bool is_decoration(const std::string& name) {
  static constexpr std::array names = {
      "nx",           "ny", "nz", "red", "green", "blue",      "alpha",    "diffuse_red", "diffuse_green",
      "diffuse_blue", "u",  "v",  "s",   "t",     "texture_u", "texture_v"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

class PlyParser {
 public:
  PlyParser(std::string_view text, const std::string& source) : scanner_(text, source), source_(source) {}

  PlySurface parse() {
    read_header();
    for (const Element& element : elements_) read_element(element);
    const std::size_t points = result_.surface.points.size();
    for (std::size_t f = 0; f < result_.surface.facets.size(); ++f)
      for (const std::uint32_t v : result_.surface.facets[f].polygons.front())
        if (v >= points)
          throw scene::bad_input(
              fmt::format("{}: face {} uses vertex {}, but the file has only {} vertices; write the file again",
                          source_, f, static_cast<std::int64_t>(v), points));
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw scene::bad_input(fmt::format("{}: {}; the file is truncated or damaged, write it again", source_, what));
  }

  std::vector<std::string_view> header_words() {
    if (scanner_.rest().substr(0, longest_line).find('\n') == std::string_view::npos) fail("its header does not end");
    return split_words(scanner_.rest_of_line());
  }

  void read_header() {
    if (header_words() != std::vector<std::string_view>{"ply"}) fail("it does not begin with 'ply'");
    bool has_format = false;
    while (true) {
      const std::vector<std::string_view> words = header_words();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format" && words.size() >= 2) {
        ascii_ = words[1] == "ascii";
        const bool big_endian = words[1] == "binary_big_endian";
        is_swapped_ = scene::is_swapped(big_endian);
        if (!ascii_ && !big_endian && words[1] != "binary_little_endian") fail("its format is " + quote(words[1]));
        has_format = true;
      } else if (words[0] == "element" && words.size() == 3) {
        const auto count = number_of<std::uint64_t>(words[2]);
        if (!count || *count > scanner_.rest().size())
          fail(fmt::format("its header states {} of element {}", quote(words[2]), quote(words[1])));
        elements_.push_back({std::string(words[1]), *count, {}});
      } else if (words[0] == "property" && !elements_.empty() && (words.size() == 3 || words.size() == 5)) {
        Property property;
        const bool is_list = words.size() == 5;
        if (is_list) property.count = scene::number_type_named(words[2], ply_types);
        const auto type = scene::number_type_named(words[is_list ? 3 : 1], ply_types);
        if (!type || (is_list && (words[1] != "list" || !property.count || *property.count >= NumberType::float32)))
          fail(fmt::format("a property of {} has an unknown type", quote(elements_.back().name)));
        property.type = *type;
        property.name = words.back();
        elements_.back().properties.push_back(std::move(property));
      } else {
        fail("its header has the unknown keyword " + quote(words[0]));
      }
    }
    if (!has_format) fail("its header names no format");
  }

  void read_element(const Element& element) {
    if (element.properties.empty()) return;
    const bool vertex = element.name == "vertex", face = element.name == "face";
    std::array<std::ptrdiff_t, 3> xyz{-1, -1, -1};
    std::vector<std::ptrdiff_t> attribute(element.properties.size(), -1);
    std::ptrdiff_t corners = -1;
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const Property& property = element.properties[k];
      if (face && property.count && (property.name == "vertex_indices" || property.name == "vertex_index"))
        corners = static_cast<std::ptrdiff_t>(k);
      if (!vertex || property.count) continue;
      if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z') {
        xyz[static_cast<std::size_t>(property.name[0] - 'x')] = static_cast<std::ptrdiff_t>(k);
      } else if (!is_decoration(property.name)) {
        attribute[k] = static_cast<std::ptrdiff_t>(result_.attribute_names.size());
        result_.attribute_names.push_back(printable_ascii(property.name));
        result_.surface.attributes.emplace_back();
      }
    }
    if (vertex && (xyz[0] < 0 || xyz[1] < 0 || xyz[2] < 0)) fail("its vertices have no x, y and z");
    // A second list of vertices would make the attributes of the first list shorter than the list of points.
    if (vertex && !result_.surface.points.empty()) fail("it has two lists of vertices");
    if (face && corners < 0) fail("its faces have no vertex_indices");
    for (std::uint64_t n = 0; n < element.count; ++n) {
      glm::dvec3 p(0);
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const Property& property = element.properties[k];
        if (property.count) {
          const bool wanted = face && static_cast<std::ptrdiff_t>(k) == corners;
          read_list(property, wanted, n);
          continue;
        }
        const double value = number(property.type);
        for (int a = 0; a < 3; ++a)
          if (xyz[static_cast<std::size_t>(a)] == static_cast<std::ptrdiff_t>(k)) p[a] = value;
        if (attribute[k] >= 0) result_.surface.attributes[static_cast<std::size_t>(attribute[k])].push_back(value);
      }
      if (vertex) result_.surface.points.push_back(p);
    }
  }

  void read_list(const Property& property, bool wanted, std::uint64_t face) {
    const double length = number(*property.count);
    if (!(length >= 0) || length > static_cast<double>(scanner_.rest().size()))
      fail(fmt::format("a list of element {} has the impossible length {}", face, length));
    cells::Polygon polygon;
    for (std::size_t k = 0; static_cast<double>(k) < length; ++k) {
      const double v = number(property.type);
      if (!wanted) continue;
      if (!(v >= 0 && v < 4294967295.0 && v == std::floor(v))) fail(fmt::format("face {} uses vertex {}", face, v));
      polygon.push_back(static_cast<std::uint32_t>(v));
    }
    if (wanted) result_.surface.facets.push_back({{std::move(polygon)}, {}});
  }

  double number(NumberType type) { return ascii_ ? ascii_number() : binary_number(type); }

  double ascii_number() {
    double value = 0;
    const Scanned found = scanner_.number(value);
    if (found == Scanned::nothing) fail("it ends before its last element");
    if (found == Scanned::other_word) fail(quote(scanner_.word().substr(0, 12)) + " is not a number");
    return value;
  }

  double binary_number(NumberType type) {
    const std::string_view bytes = scanner_.rest();
    return scene::with_number_type(type, [&](auto zero) {
      if (bytes.size() < sizeof zero) fail("it ends before its last element");
      scanner_.go_to(scanner_.at() + sizeof zero);
      return static_cast<double>(scene::load<decltype(zero)>(bytes.data(), is_swapped_));
    });
  }

  static constexpr std::size_t longest_line = 1 << 20;

  TextScanner scanner_;
  const std::string& source_;
  bool ascii_ = true, is_swapped_ = false;
  std::vector<Element> elements_;
  PlySurface result_;
};

}  // namespace

PlySurface parse_ply(std::string_view text, const std::string& source) { return PlyParser(text, source).parse(); }

}  // namespace tessera::io
