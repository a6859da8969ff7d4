// SPDX-License-Identifier: BSD-3-Clause
#include "cells/curved/node_orders.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::cells {
namespace {

constexpr std::array<std::uint8_t, 8> exodus_tet8 = {0, 1, 2, 3, 6, 4, 5, 7};
constexpr std::array<std::uint8_t, 14> exodus_tet14 = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 13, 11, 12};
constexpr std::array<std::uint8_t, 15> exodus_tet15 = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 14, 12, 13, 10};
constexpr std::array<std::uint8_t, 16> exodus_tet16 = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 13, 11, 14, 12, 15};
constexpr std::array<std::uint8_t, 15> exodus_wedge15 = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11};
constexpr std::array<std::uint8_t, 16> exodus_wedge16 = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11, 15};
constexpr std::array<std::uint8_t, 18> exodus_wedge18 = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11, 15, 16, 17};
constexpr std::array<std::uint8_t, 20> exodus_wedge20 = {0,  1,  2, 3,  4,  5,  6,  7,  8,  12,
                                                         13, 14, 9, 10, 11, 15, 16, 19, 17, 18};
constexpr std::array<std::uint8_t, 21> exodus_wedge21 = {0,  1, 2,  3,  4,  5,  6,  7,  8,  12, 13,
                                                         14, 9, 10, 11, 16, 17, 20, 18, 19, 15};
constexpr std::array<std::uint8_t, 24> exodus_wedge24 = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11,
                                                         18, 19, 20, 21, 22, 23, 12, 15, 13, 16, 14, 17};
constexpr std::array<std::uint8_t, 20> exodus_hexahedron20 = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,
                                                              10, 11, 16, 17, 18, 19, 12, 13, 14, 15};
constexpr std::array<std::uint8_t, 21> exodus_hexahedron21 = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9, 10,
                                                              11, 16, 17, 18, 19, 12, 13, 14, 15, 20};
constexpr std::array<std::uint8_t, 27> exodus_hexahedron27 = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 16, 17,
                                                              18, 19, 12, 13, 14, 15, 23, 24, 25, 26, 21, 22, 20};
constexpr std::array<std::uint8_t, 64> exodus_hexahedron64 = {
    0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 13, 12, 15, 14, 24, 25, 26, 27, 29, 28,
    31, 30, 16, 20, 17, 21, 18, 22, 19, 23, 43, 42, 55, 54, 38, 39, 50, 51, 36, 37, 48, 49,
    41, 40, 53, 52, 32, 33, 35, 34, 60, 61, 63, 62, 44, 45, 47, 46, 56, 57, 59, 58};
constexpr std::array<std::uint8_t, 27> med_hexahedron27 = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13,
                                                           14, 15, 16, 17, 18, 19, 24, 22, 21, 23, 20, 25, 26};
constexpr std::array<std::uint8_t, 27> cgns_hexahedron27 = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 16, 17,
                                                            18, 19, 12, 13, 14, 15, 24, 22, 21, 23, 20, 25, 26};
constexpr std::array<std::uint8_t, 20> cgns_tet20 = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,
                                                     10, 11, 12, 13, 14, 15, 17, 18, 19, 16};
constexpr std::array<std::uint8_t, 40> cgns_wedge40 = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 18, 19,
                                                       20, 21, 22, 23, 12, 13, 14, 15, 16, 17, 24, 37, 25, 26,
                                                       28, 27, 29, 30, 32, 31, 33, 34, 36, 35, 38, 39};
constexpr std::array<std::uint8_t, 30> cgns_pyramid30 = {0,  1,  2,  3,  4,  5,  6,  7,  8,  10, 9,  12, 11, 13, 14,
                                                         15, 16, 17, 18, 19, 20, 21, 22, 24, 23, 25, 26, 27, 28, 29};
constexpr std::array<std::uint8_t, 64> cgns_hexahedron64 = {
    0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 13, 12, 15, 14, 24, 25, 26, 27, 29, 28,
    31, 30, 16, 17, 18, 19, 20, 21, 22, 23, 49, 48, 50, 51, 40, 41, 43, 42, 36, 37, 39, 38,
    45, 44, 46, 47, 32, 33, 35, 34, 52, 53, 55, 54, 56, 57, 59, 58, 60, 61, 63, 62};
constexpr std::array<std::uint8_t, 10> tetgen_tet10 = {0, 1, 2, 3, 6, 7, 9, 5, 8, 4};
constexpr std::array<std::uint8_t, 15> tet15_with_centre_last = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 13, 11, 12, 14};

constexpr std::array<std::uint8_t, 21> ioss_wedge21 = {0,  1, 2,  3,  4,  5,  6,  7,  8,  12, 13,
                                                       14, 9, 10, 11, 15, 16, 20, 18, 19, 17};

/// Node orders of cells that have only the first nodes of another cell.
template <std::size_t all>
constexpr std::span<const std::uint8_t> first_of(const std::array<std::uint8_t, all>& order, std::size_t nodes) {
  return std::span(order).first(nodes);
}

using enum NodeConvention;

constexpr NodeOrder rows[] = {
    {exodus, CurvedFamily::tet, 4, CellType::tetra, {}},
    {exodus, CurvedFamily::tet, 5, CellType::lagrange_tetrahedron, {}},
    {exodus, CurvedFamily::tet, 7, CellType::lagrange_tetrahedron, {}},
    {exodus, CurvedFamily::tet, 8, CellType::lagrange_tetrahedron, exodus_tet8},
    {exodus, CurvedFamily::tet, 10, CellType::quadratic_tetra, {}},
    {exodus, CurvedFamily::tet, 11, CellType::lagrange_tetrahedron, {}},
    {exodus, CurvedFamily::tet, 14, CellType::lagrange_tetrahedron, exodus_tet14},
    {exodus, CurvedFamily::tet, 15, CellType::lagrange_tetrahedron, exodus_tet15},
    {exodus, CurvedFamily::tet, 16, CellType::lagrange_tetrahedron, exodus_tet16},
    {exodus, CurvedFamily::pyramid, 5, CellType::pyramid, {}},
    {exodus, CurvedFamily::pyramid, 13, CellType::quadratic_pyramid, {}},
    {exodus, CurvedFamily::pyramid, 14, CellType::lagrange_pyramid, {}},
    {exodus, CurvedFamily::pyramid, 18, CellType::lagrange_pyramid, {}},
    {exodus, CurvedFamily::pyramid, 19, CellType::triquadratic_pyramid, {}},
    {exodus, CurvedFamily::wedge, 6, CellType::wedge, {}},
    {exodus, CurvedFamily::wedge, 12, CellType::quadratic_linear_wedge, {}},
    {exodus, CurvedFamily::wedge, 15, CellType::quadratic_wedge, exodus_wedge15},
    {exodus, CurvedFamily::wedge, 16, CellType::lagrange_wedge, exodus_wedge16},
    {exodus, CurvedFamily::wedge, 18, CellType::biquadratic_quadratic_wedge, exodus_wedge18},
    {exodus, CurvedFamily::wedge, 20, CellType::lagrange_wedge, exodus_wedge20},
    {exodus, CurvedFamily::wedge, 21, CellType::lagrange_wedge, exodus_wedge21},
    {exodus, CurvedFamily::wedge, 24, CellType::lagrange_wedge, exodus_wedge24},
    {exodus, CurvedFamily::hexahedron, 8, CellType::hexahedron, {}},
    {exodus, CurvedFamily::hexahedron, 9, CellType::lagrange_hexahedron, {}},
    {exodus, CurvedFamily::hexahedron, 16, CellType::lagrange_hexahedron, {}},
    {exodus, CurvedFamily::hexahedron, 20, CellType::quadratic_hexahedron, exodus_hexahedron20},
    {exodus, CurvedFamily::hexahedron, 21, CellType::lagrange_hexahedron, exodus_hexahedron21},
    {exodus, CurvedFamily::hexahedron, 27, CellType::triquadratic_hexahedron, exodus_hexahedron27},
    {exodus, CurvedFamily::hexahedron, 32, CellType::lagrange_hexahedron, first_of(exodus_hexahedron64, 32)},
    {exodus, CurvedFamily::hexahedron, 64, CellType::lagrange_hexahedron, exodus_hexahedron64},
    {med, CurvedFamily::tet, 4, CellType::tetra, {}},
    {med, CurvedFamily::tet, 10, CellType::quadratic_tetra, {}},
    {med, CurvedFamily::pyramid, 5, CellType::pyramid, {}},
    {med, CurvedFamily::pyramid, 13, CellType::quadratic_pyramid, {}},
    {med, CurvedFamily::wedge, 6, CellType::wedge, {}},
    {med, CurvedFamily::wedge, 15, CellType::quadratic_wedge, {}},
    {med, CurvedFamily::wedge, 18, CellType::biquadratic_quadratic_wedge, {}},
    {med, CurvedFamily::hexahedron, 8, CellType::hexahedron, {}},
    {med, CurvedFamily::hexahedron, 20, CellType::quadratic_hexahedron, {}},
    {med, CurvedFamily::hexahedron, 27, CellType::triquadratic_hexahedron, med_hexahedron27},
    {nastran, CurvedFamily::tet, 4, CellType::tetra, {}},
    {nastran, CurvedFamily::tet, 10, CellType::quadratic_tetra, {}},
    {nastran, CurvedFamily::pyramid, 5, CellType::pyramid, {}},
    {nastran, CurvedFamily::pyramid, 13, CellType::quadratic_pyramid, {}},
    {nastran, CurvedFamily::wedge, 6, CellType::wedge, {}},
    {nastran, CurvedFamily::wedge, 15, CellType::quadratic_wedge, exodus_wedge15},
    {nastran, CurvedFamily::hexahedron, 8, CellType::hexahedron, {}},
    {nastran, CurvedFamily::hexahedron, 20, CellType::quadratic_hexahedron, exodus_hexahedron20},
    {cgns, CurvedFamily::tet, 4, CellType::tetra, {}},
    {cgns, CurvedFamily::tet, 10, CellType::quadratic_tetra, {}},
    {cgns, CurvedFamily::tet, 16, CellType::lagrange_tetrahedron, {}},
    {cgns, CurvedFamily::tet, 20, CellType::lagrange_tetrahedron, cgns_tet20},
    {cgns, CurvedFamily::pyramid, 5, CellType::pyramid, {}},
    {cgns, CurvedFamily::pyramid, 13, CellType::quadratic_pyramid, {}},
    {cgns, CurvedFamily::pyramid, 14, CellType::lagrange_pyramid, {}},
    {cgns, CurvedFamily::pyramid, 21, CellType::lagrange_pyramid, first_of(cgns_pyramid30, 21)},
    {cgns, CurvedFamily::pyramid, 29, CellType::lagrange_pyramid, first_of(cgns_pyramid30, 29)},
    {cgns, CurvedFamily::pyramid, 30, CellType::lagrange_pyramid, cgns_pyramid30},
    {cgns, CurvedFamily::wedge, 6, CellType::wedge, {}},
    {cgns, CurvedFamily::wedge, 15, CellType::quadratic_wedge, exodus_wedge15},
    {cgns, CurvedFamily::wedge, 18, CellType::biquadratic_quadratic_wedge, exodus_wedge18},
    {cgns, CurvedFamily::wedge, 24, CellType::lagrange_wedge, first_of(cgns_wedge40, 24)},
    {cgns, CurvedFamily::wedge, 38, CellType::lagrange_wedge, first_of(cgns_wedge40, 38)},
    {cgns, CurvedFamily::wedge, 40, CellType::lagrange_wedge, cgns_wedge40},
    {cgns, CurvedFamily::hexahedron, 8, CellType::hexahedron, {}},
    {cgns, CurvedFamily::hexahedron, 20, CellType::quadratic_hexahedron, exodus_hexahedron20},
    {cgns, CurvedFamily::hexahedron, 27, CellType::triquadratic_hexahedron, cgns_hexahedron27},
    {cgns, CurvedFamily::hexahedron, 32, CellType::lagrange_hexahedron, first_of(cgns_hexahedron64, 32)},
    {cgns, CurvedFamily::hexahedron, 56, CellType::lagrange_hexahedron, first_of(cgns_hexahedron64, 56)},
    {cgns, CurvedFamily::hexahedron, 64, CellType::lagrange_hexahedron, cgns_hexahedron64},
    {tetgen, CurvedFamily::tet, 10, CellType::quadratic_tetra, tetgen_tet10},
};

constexpr NodeOrder other_tet15 = {exodus, CurvedFamily::tet, 15, CellType::lagrange_tetrahedron,
                                   tet15_with_centre_last};

constexpr NodeOrder other_wedge21 = {exodus, CurvedFamily::wedge, 21, CellType::lagrange_wedge, ioss_wedge21};

template <class Number>
void exchange(std::span<Number> nodes, std::array<int, 3> degrees) {
  if (degrees[0] < 1 || degrees[1] < 1 || degrees[2] < 1)
    degrees.fill(static_cast<int>(std::lround(std::cbrt(static_cast<double>(nodes.size())))) - 1);
  const auto n = [&](std::size_t axis) { return static_cast<std::size_t>(degrees[axis]); };
  if (degrees[2] < 2 || (n(0) + 1) * (n(1) + 1) * (n(2) + 1) != nodes.size()) return;
  const std::size_t first = 8 + 4 * (n(0) - 1) + 4 * (n(1) - 1) + 2 * (n(2) - 1);
  std::ranges::swap_ranges(nodes.subspan(first, n(2) - 1), nodes.subspan(first + n(2) - 1, n(2) - 1));
}

}  // namespace

const NodeOrder* find_node_order(NodeConvention convention, CurvedFamily shape, std::size_t nodes) {
  const auto* const found = std::ranges::find_if(rows, [&](const NodeOrder& row) {
    return row.convention == convention && row.shape == shape && row.nodes == nodes;
  });
  return found == std::end(rows) ? nullptr : found;
}

std::span<const NodeOrder> all_node_orders() { return rows; }

const NodeOrder& exodus_tet15_with_centre_last() { return other_tet15; }

const NodeOrder& exodus_wedge21_of_ioss() { return other_wedge21; }

void to_vtk_order(const NodeOrder& order, std::span<std::uint32_t> nodes) {
  if (order.from.empty()) return;
  std::array<std::uint32_t, 64> theirs;
  std::ranges::copy(nodes.first(order.from.size()), theirs.begin());
  for (std::size_t k = 0; k < order.from.size(); ++k) nodes[k] = theirs[order.from[k]];
}

void exchange_vtk8_edges(std::span<std::uint32_t> nodes, const std::array<int, 3>& degrees) {
  exchange(nodes, degrees);
}
void exchange_vtk8_edges(std::span<long long> nodes, const std::array<int, 3>& degrees) { exchange(nodes, degrees); }

}  // namespace tessera::cells
