// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/tetgen_files.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <span>

#include "cells/curved/node_orders.hpp"
#include "io/text/scanner.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// Parses TetGen's text: lines of numbers; `#` begins a comment; blank lines are ignored.
class Numbers {
 public:
  Numbers(std::string_view text, const std::string& source) : scanner_(text, source, " \t\r,\v\f", '#') {}

  /// Moves to the next line with content. Returns false at the end.
  bool next_line() { return scanner_.next_line(); }

  void need_line(const char* what) {
    if (!next_line()) fail(fmt::format("the file ends where {} should be", what));
  }

  /// Reads the next number of this line; no value if there is none.
  template <class T>
  std::optional<T> maybe() {
    T value{};
    const Scanned found = scanner_.number(value);
    if (found == Scanned::nothing) return std::nullopt;
    if (found == Scanned::other_word)
      fail(fmt::format("'{}' is not {}", scanner_.word().substr(0, 20),
                       std::is_integral_v<T> ? "a whole number" : "a number"));
    // 1e999 becomes NaN: a cell with this number is blanked.
    if (found == Scanned::out_of_range && std::is_integral_v<T>) fail("a number is too large");
    return value;
  }

  template <class T>
  T need(const char* what) {
    if (const std::optional<T> value = maybe<T>()) return *value;
    fail(fmt::format("{} is missing", what));
  }

  /// Reads a number like `need`, if necessary from one of the following lines.
  template <class T>
  T need_across_lines(const char* what) {
    if (scanner_.at_end()) need_line(what);
    return need<T>(what);
  }

  /// Reads a count of items that take at least `least` bytes of text each.
  std::size_t count(const char* what, std::size_t least) {
    const auto n = need<std::int64_t>(what);
    if (n < 0 || static_cast<std::uint64_t>(n) > scanner_.rest().size() / least + 1)
      fail(fmt::format("{} is {}, more than a file of this size can contain", what, n));
    return static_cast<std::size_t>(n);
  }

  [[noreturn]] void fail(const std::string& what) const { scanner_.fail(what + "; write the file again"); }

 private:
  TextScanner scanner_;
};

struct Nodes {
  std::vector<glm::dvec3> points;
  std::vector<std::vector<double>> attributes;
  std::vector<double> markers;
  std::int64_t first_index = 0;
};

/// Parses the point list of a .node file. Files .poly and .smesh begin with the same list.
Nodes parse_nodes(Numbers& in) {
  Nodes nodes;
  in.need_line("the number of points");
  const std::size_t n = in.count("the number of points", 8);
  const auto dimensions = in.maybe<std::int64_t>().value_or(3);
  if (dimensions != 3) in.fail(fmt::format("the points have {} coordinates, not 3", dimensions));
  const auto attributes = in.maybe<std::int64_t>().value_or(0), markers = in.maybe<std::int64_t>().value_or(0);
  if (attributes < 0 || attributes > 1000 || markers < 0 || markers > 1)
    in.fail(fmt::format("{} attributes and {} markers per point are not supported", attributes, markers));
  nodes.points.reserve(n);
  nodes.attributes.resize(static_cast<std::size_t>(attributes));
  for (std::size_t v = 0; v < n; ++v) {
    in.need_line("a point");
    const auto index = in.need<std::int64_t>("the point's number");
    if (v == 0) nodes.first_index = index;
    if (nodes.first_index < 0 || nodes.first_index > 1)
      in.fail(fmt::format("points are numbered from {}, not from 0 or 1", nodes.first_index));
    if (index != nodes.first_index + static_cast<std::int64_t>(v))
      in.fail(fmt::format("point {} is listed where {} should be", index,
                          nodes.first_index + static_cast<std::int64_t>(v)));
    const auto x = in.need<double>("x"), y = in.need<double>("y"), z = in.need<double>("z");
    nodes.points.emplace_back(x, y, z);
    for (std::vector<double>& values : nodes.attributes) values.push_back(in.need<double>("an attribute"));
    if (markers == 1) nodes.markers.push_back(in.maybe<double>().value_or(0));
  }
  return nodes;
}

std::uint32_t point_index(Numbers& in, std::int64_t given, const Nodes& nodes) {
  const std::int64_t v = given - nodes.first_index;
  if (v < 0 || v >= static_cast<std::int64_t>(nodes.points.size()))
    in.fail(fmt::format("point {} is used, but there are only {} points, numbered from {}", given, nodes.points.size(),
                        nodes.first_index));
  return static_cast<std::uint32_t>(v);
}

cells::Polygon read_polygon(Numbers& in, const Nodes& nodes) {
  cells::Polygon polygon(in.count("a polygon's number of corners", 2));
  for (std::uint32_t& v : polygon)
    v = point_index(in, in.need_across_lines<std::int64_t>("a corner of the polygon"), nodes);
  return polygon;
}

glm::dvec3 read_hole(Numbers& in) {
  in.need_line("a hole");
  in.need<std::int64_t>("the hole's number");
  const auto x = in.need<double>("x"), y = in.need<double>("y"), z = in.need<double>("z");
  return {x, y, z};
}

}  // namespace

cells::CellBlock parse_node_ele(std::string_view node, std::string_view ele, const std::string& node_source,
                                const std::string& ele_source) {
  Numbers node_numbers(node, node_source), in(ele, ele_source);
  Nodes nodes = parse_nodes(node_numbers);

  in.need_line("the number of tets");
  const std::size_t n = in.count("the number of tets", 10);
  const auto corners = in.maybe<std::int64_t>().value_or(4), attributes = in.maybe<std::int64_t>().value_or(0);
  if (corners != 4 && corners != 10) in.fail(fmt::format("tets have 4 or 10 nodes, not {}", corners));
  if (attributes < 0 || attributes > 1000) in.fail(fmt::format("{} attributes per tet are not supported", attributes));
  const auto nodes_each = static_cast<std::size_t>(corners);
  const cells::NodeOrder& order = *find_node_order(cells::NodeConvention::tetgen, cells::CurvedFamily::tet, 10);
  cells::CellBlock block;
  nodes_each == 4 ? block.tets.resize(n) : block.connectivity.resize(nodes_each * n);
  std::vector<std::vector<double>> cell_values(static_cast<std::size_t>(attributes));
  for (std::size_t t = 0; t < n; ++t) {
    in.need_line("a tet");
    in.need<std::int64_t>("the tet's number");
    for (std::size_t k = 0; k < nodes_each; ++k)
      (nodes_each == 4 ? block.tets[t][k] : block.connectivity[nodes_each * t + k]) =
          point_index(in, in.need<std::int64_t>("a corner"), nodes);
    if (nodes_each == 10) cells::to_vtk_order(order, std::span(block.connectivity).subspan(nodes_each * t, nodes_each));
    for (std::vector<double>& values : cell_values) values.push_back(in.need<double>("an attribute"));
  }
  if (nodes_each == 10) {
    block.types.assign(n, vtk_number(order.type));
    block.offsets.resize(n + 1);
    for (std::size_t c = 0; c <= n; ++c) block.offsets[c] = 10 * c;
  }
  block.positions = std::move(nodes.points);
  for (std::size_t a = 0; a < nodes.attributes.size(); ++a)
    block.fields.push_back(cells::field_of_values(fmt::format("attribute{}", a), "double", scene::Association::point, 1,
                                                  std::move(nodes.attributes[a])));
  for (std::size_t a = 0; a < cell_values.size(); ++a)
    block.fields.push_back(cells::field_of_values(fmt::format("attribute{}", a), "double", scene::Association::cell, 1,
                                                  std::move(cell_values[a])));
  if (!nodes.markers.empty())
    block.fields.push_back(
        cells::field_of_values("marker", "int32", scene::Association::point, 1, std::move(nodes.markers)));
  return block;
}

cells::Surface parse_tetgen_surface(std::string_view text, bool smesh, std::string_view node, const std::string& source,
                                    const std::string& node_source) {
  Numbers in(text, source);
  Nodes nodes = parse_nodes(in);
  if (nodes.points.empty()) {
    Numbers node_numbers(node, node_source);
    nodes = parse_nodes(node_numbers);
  }
  cells::Surface surface;
  in.need_line("the number of facets");
  surface.facets.resize(in.count("the number of facets", 4));
  for (cells::Facet& facet : surface.facets) {
    in.need_line("a facet");
    if (smesh) {
      facet.polygons.push_back(read_polygon(in, nodes));
      continue;  // a marker may follow the attributes
    }
    const std::size_t polygons = in.count("a facet's number of polygons", 2);
    const auto holes = in.maybe<std::int64_t>().value_or(0);
    if (holes < 0) in.fail(fmt::format("a facet cannot have {} holes", holes));
    for (std::size_t k = 0; k < polygons; ++k) {
      in.need_line("a polygon");
      facet.polygons.push_back(read_polygon(in, nodes));
    }
    for (std::int64_t k = 0; k < holes; ++k) facet.holes.push_back(read_hole(in));
  }
  if (in.next_line()) {
    const std::size_t holes = in.count("the number of holes", 8);
    for (std::size_t k = 0; k < holes; ++k) surface.cavities.push_back(read_hole(in));
  }
  surface.points = std::move(nodes.points);
  surface.attributes = std::move(nodes.attributes);
  return surface;
}

}  // namespace tessera::io
