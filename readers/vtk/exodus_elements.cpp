// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/exodus_elements.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

struct Middle {
  std::uint8_t node;
  std::initializer_list<std::uint8_t> corners;
};

/// Corrects the node order of the cells that have the type and number of nodes of `other`. Only one kind of Exodus
/// element has both; its middle nodes are in one of two orders.
void settle(cells::CellBlock& block, const cells::NodeOrder& other, std::initializer_list<Middle> middles) {
  const cells::NodeOrder& manual = *find_node_order(other.convention, other.shape, other.nodes);
  const auto far_from_middles = [&](std::span<const std::uint32_t> nodes) {
    double far = 0;
    for (const Middle& middle : middles) {
      glm::dvec3 mean(0);
      for (const std::uint8_t corner : middle.corners) mean += block.positions[nodes[corner]];
      const glm::dvec3 d = block.positions[nodes[middle.node]] - mean / static_cast<double>(middle.corners.size());
      far += glm::dot(d, d);
    }
    return far;
  };
  std::array<std::uint32_t, 64> buffer{};
  const auto in_other_order = [&](std::span<const std::uint32_t> nodes) {
    for (std::size_t k = 0; k < nodes.size(); ++k) buffer[manual.from[k]] = nodes[k];
    cells::to_vtk_order(other, std::span(buffer).first(nodes.size()));
    return std::span<const std::uint32_t>(buffer).first(nodes.size());
  };
  std::vector<std::span<std::uint32_t>> cells;
  double as_manual = 0, as_other = 0;
  for (std::size_t c = 0; c < block.types.size(); ++c) {
    if (block.types[c] != vtk_number(other.type) || block.offsets[c + 1] - block.offsets[c] != other.nodes) continue;
    cells.push_back(std::span(block.connectivity).subspan(block.offsets[c], other.nodes));
    as_manual += far_from_middles(cells.back());
    as_other += far_from_middles(in_other_order(cells.back()));
  }
  if (!(as_other < as_manual)) return;
  for (const std::span<std::uint32_t> cell : cells) std::ranges::copy(in_other_order(cell), cell.begin());
}

}  // namespace

std::string exodus_topology(const ex_block& info) {
  return upper_case(std::string_view(info.topology, ::strnlen(info.topology, sizeof info.topology)));
}

ExodusElement exodus_element(const std::string& topology, std::int64_t nodes) {
  struct Solid {
    std::string_view beginning;
    cells::CurvedFamily shape;
    std::int64_t corners;
    CellType other;  ///< type if the number of nodes is different
  };
  static constexpr Solid solids[] = {{"HEX", cells::CurvedFamily::hexahedron, 8, CellType::lagrange_hexahedron},
                                     {"TET", cells::CurvedFamily::tet, 4, CellType::lagrange_tetrahedron},
                                     {"WED", cells::CurvedFamily::wedge, 6, CellType::lagrange_wedge},
                                     {"PYR", cells::CurvedFamily::pyramid, 5, CellType::lagrange_pyramid}};
  for (const Solid& solid : solids) {
    if (!topology.starts_with(solid.beginning) || nodes < solid.corners) continue;
    const cells::NodeOrder* const order =
        cells::find_node_order(cells::NodeConvention::exodus, solid.shape, static_cast<std::size_t>(nodes));
    return {order != nullptr ? order->type : solid.other, order};
  }
  if (topology.starts_with("NFA")) return {CellType::polyhedron, nullptr};
  for (const char* flat :
       {"SHE", "QUA", "TRI", "BAR", "BEA", "TRU", "SPH", "CIR", "NSI", "EDG", "LIN", "POI", "RIG", "CON"})
    if (topology.starts_with(flat)) return {CellType::quad, nullptr};
  return {};
}

std::span<const std::uint8_t> exodus_side(const std::string& topology, std::int64_t side) {
  using Quadrilateral = std::array<std::uint8_t, 4>;
  using Triangle = std::array<std::uint8_t, 3>;
  static constexpr Quadrilateral of_hexahedra[] = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6},
                                                   {0, 4, 7, 3}, {0, 3, 2, 1}, {4, 5, 6, 7}},
                                 of_wedges[] = {{0, 1, 4, 3}, {1, 2, 5, 4}, {0, 3, 5, 2}};
  static constexpr Quadrilateral of_pyramids = {0, 3, 2, 1};
  static constexpr Triangle of_tets[] = {{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 2, 1}},
                            ends_of_wedges[] = {{0, 2, 1}, {3, 4, 5}},
                            around_pyramids[] = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {0, 4, 3}};
  if (side < 1 || side > 6) return {};
  const auto number = static_cast<std::size_t>(side) - 1;
  if (topology.starts_with("HEX")) return of_hexahedra[number];
  if (topology.starts_with("TET") && number < 4) return of_tets[number];
  if (topology.starts_with("WED") && number < 3) return of_wedges[number];
  if (topology.starts_with("WED") && number < 5) return ends_of_wedges[number - 3];
  if (topology.starts_with("PYR") && number < 4) return around_pyramids[number];
  if (topology.starts_with("PYR") && number < 5) return of_pyramids;
  return {};
}

void settle_exodus_middles(cells::CellBlock& block) {
  settle(block, cells::exodus_tet15_with_centre_last(), {{10, {0, 1, 2}}, {11, {0, 1, 3}}, {14, {0, 1, 2, 3}}});
  settle(block, cells::exodus_wedge21_of_ioss(), {{15, {0, 1, 2}}, {16, {3, 4, 5}}, {20, {0, 1, 2, 3, 4, 5}}});
}

}  // namespace tessera::readers
