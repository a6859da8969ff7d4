#include "io/helper/exodus_elements.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <string_view>

namespace tessera::io::helper {
namespace {

/// VTK's Lagrange tetrahedron of 15 nodes, which no other of Exodus' elements becomes.
bool is_tet15(const CellBlock& block, std::size_t cell) {
  return block.types[cell] == 71 && block.offsets[cell + 1] - block.offsets[cell] == 15;
}

}  // namespace

std::string exodus_topology(const ex_block& info) {
  std::string topology(info.topology, ::strnlen(info.topology, sizeof info.topology));
  std::ranges::transform(topology, topology.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return topology;
}

ExodusElement exodus_element(const std::string& topology, std::int64_t nodes) {
  struct Solid {
    std::string_view beginning;
    CurvedFamily shape;
    std::int64_t corners;
    std::uint8_t other;  ///< its type for other numbers of nodes
  };
  static constexpr Solid solids[] = {{"HEX", CurvedFamily::hexahedron, 8, 72},
                                     {"TET", CurvedFamily::tet, 4, 71},
                                     {"WED", CurvedFamily::wedge, 6, 73},
                                     {"PYR", CurvedFamily::pyramid, 5, 74}};
  for (const Solid& solid : solids) {
    if (!topology.starts_with(solid.beginning) || nodes < solid.corners) continue;
    const NodeOrder* const order =
        find_node_order(NodeConvention::exodus, solid.shape, static_cast<std::size_t>(nodes));
    return {order != nullptr ? order->vtk_type : solid.other, order};
  }
  if (topology.starts_with("NFA")) return {42, nullptr};
  for (const char* flat :
       {"SHE", "QUA", "TRI", "BAR", "BEA", "TRU", "SPH", "CIR", "NSI", "EDG", "LIN", "POI", "RIG", "CON"})
    if (topology.starts_with(flat)) return {9, nullptr};
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

void settle_exodus_tet15(CellBlock& block) {
  const NodeOrder& other = exodus_tet15_with_centre_last();
  const NodeOrder& manual = *find_node_order(other.convention, other.shape, other.nodes);
  const auto nodes_of = [&](std::size_t c) { return std::span(block.connectivity).subspan(block.offsets[c], 15); };
  const auto far = [&](std::uint32_t node, std::initializer_list<std::uint32_t> corners) {
    glm::dvec3 mean(0);
    for (const std::uint32_t corner : corners) mean += block.positions[corner];
    const glm::dvec3 d = block.positions[node] - mean / static_cast<double>(corners.size());
    return glm::dot(d, d);
  };
  // Which of the two is inside, the eleventh or the fifteenth, and which of a face.
  double as_manual = 0, centre_last = 0;
  for (std::size_t c = 0; c < block.types.size(); ++c) {
    if (!is_tet15(block, c)) continue;
    const auto n = nodes_of(c);
    const std::uint32_t eleventh = n[14], fifteenth = n[11];
    as_manual += far(eleventh, {n[0], n[1], n[2], n[3]}) + far(fifteenth, {n[0], n[1], n[3]});
    centre_last += far(fifteenth, {n[0], n[1], n[2], n[3]}) + far(eleventh, {n[0], n[1], n[2]});
  }
  if (!(centre_last < as_manual)) return;
  for (std::size_t c = 0; c < block.types.size(); ++c) {
    if (!is_tet15(block, c)) continue;
    std::array<std::uint32_t, 15> theirs{};
    const auto n = nodes_of(c);
    for (std::size_t k = 0; k < 15; ++k) theirs[manual.from[k]] = n[k];
    std::ranges::copy(theirs, n.begin());
    to_vtk_order(other, n);
  }
}

}  // namespace tessera::io::helper
