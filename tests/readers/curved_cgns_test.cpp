// SPDX-License-Identifier: BSD-3-Clause
// Cells of second and third order in CGNS files, written by the CGNS library in the order of SIDS.
#include <gtest/gtest.h>
#include <vtk_cgns.h>
#include VTK_CGNS(cgnslib.h)

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "support/curved_reference.hpp"
#include "support/read_files.hpp"
#include "support/some_cases.hpp"
#include "support/temporary_folder.hpp"
#include "support/vtk_or_skip.hpp"

namespace tessera::io::curved_cgns_test {
namespace {

using testing::BentCell;
using testing::CellSpace;
using testing::ReferenceCell;

std::vector<std::vector<int>> hex64_lists() {
  using testing::a_third, testing::near_first;
  static constexpr std::array<std::array<int, 2>, 12> edges = {
      {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 5}, {2, 6}, {3, 7}, {4, 8}, {5, 6}, {6, 7}, {7, 8}, {8, 5}}};
  static constexpr std::array<std::array<int, 4>, 6> faces = {
      {{1, 2, 3, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}, {5, 6, 7, 8}}};
  std::vector<std::vector<int>> lists;
  for (const auto& [a, b] : edges) lists.push_back(a_third(a, b)), lists.push_back(a_third(b, a));
  for (const auto& f : faces)
    for (std::size_t k = 0; k < 4; ++k)
      lists.push_back(near_first({f[k], f[(k + 1) % 4], f[(k + 2) % 4], f[(k + 3) % 4]}));
  for (int k = 1; k <= 8; ++k) lists.push_back(testing::near_corner_of_hexahedron(k));
  return lists;
}

std::vector<std::vector<int>> pyramid30_lists() {
  using testing::a_third, testing::near_first;
  static constexpr std::array<std::array<int, 2>, 8> edges = {
      {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 5}, {2, 5}, {3, 5}, {4, 5}}};
  std::vector<std::vector<int>> lists;
  for (const auto& [a, b] : edges) lists.push_back(a_third(a, b)), lists.push_back(a_third(b, a));
  for (const std::array<int, 4>& base :
       std::array<std::array<int, 4>, 4>{{{1, 2, 3, 4}, {2, 3, 4, 1}, {3, 4, 1, 2}, {4, 1, 2, 3}}})
    lists.push_back(near_first(base));
  lists.insert(lists.end(), {{1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {4, 1, 5}, {1, 2, 3, 4, 5, 5}});
  return lists;
}

std::vector<std::vector<int>> tet20_lists() {
  using testing::a_third;
  static constexpr std::array<std::array<int, 2>, 6> edges = {{{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 4}, {3, 4}}};
  std::vector<std::vector<int>> lists;
  for (const auto& [a, b] : edges) lists.push_back(a_third(a, b)), lists.push_back(a_third(b, a));
  lists.insert(lists.end(), {{1, 2, 3}, {1, 2, 4}, {2, 3, 4}, {3, 1, 4}});
  return lists;
}

std::vector<std::vector<int>> wedge40_lists() {
  using testing::a_third, testing::near_first;
  static constexpr std::array<std::array<int, 2>, 9> edges = {
      {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 5}, {3, 6}, {4, 5}, {5, 6}, {6, 4}}};
  static constexpr std::array<std::array<int, 4>, 3> sides = {{{1, 2, 5, 4}, {2, 3, 6, 5}, {3, 1, 4, 6}}};
  std::vector<std::vector<int>> lists;
  for (const auto& [a, b] : edges) lists.push_back(a_third(a, b)), lists.push_back(a_third(b, a));
  lists.push_back({1, 2, 3});
  for (const auto& f : sides)
    for (std::size_t k = 0; k < 4; ++k)
      lists.push_back(near_first({f[k], f[(k + 1) % 4], f[(k + 2) % 4], f[(k + 3) % 4]}));
  lists.insert(lists.end(), {{4, 5, 6}, {1, 1, 2, 2, 3, 3, 4, 5, 6}, {1, 2, 3, 4, 4, 5, 5, 6, 6}});
  return lists;
}

std::vector<std::vector<int>> first_of(std::vector<std::vector<int>> lists, std::size_t count) {
  lists.resize(count);
  return lists;
}

std::vector<std::pair<ReferenceCell, CGNS_ENUMT(ElementType_t)>> sids_cells() {
  const std::vector<std::vector<int>> hex20 = {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 5}, {2, 6},
                                               {3, 7}, {4, 8}, {5, 6}, {6, 7}, {7, 8}, {8, 5}},
                                      wedge15 = {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 5},
                                                 {3, 6}, {4, 5}, {5, 6}, {6, 4}},
                                      tet10 = {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 4}, {3, 4}},
                                      pyramid13 = {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 5}, {2, 5}, {3, 5}, {4, 5}};
  std::vector<std::vector<int>> hex27 = hex20, wedge18 = wedge15, pyramid14 = pyramid13;
  hex27.insert(
      hex27.end(),
      {{1, 2, 3, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {1, 5, 8, 4}, {5, 6, 7, 8}, {1, 2, 3, 4, 5, 6, 7, 8}});
  wedge18.insert(wedge18.end(), {{1, 2, 5, 4}, {2, 3, 6, 5}, {3, 1, 4, 6}});
  pyramid14.push_back({1, 2, 3, 4});
  constexpr auto hexahedron = cells::CurvedFamily::hexahedron, tet = cells::CurvedFamily::tet,
                 wedge = cells::CurvedFamily::wedge, pyramid = cells::CurvedFamily::pyramid;
  return {{{"TETRA_10", tet, tet10}, CGNS_ENUMV(TETRA_10)},
          {{"TETRA_16", tet, first_of(tet20_lists(), 12)}, CGNS_ENUMV(TETRA_16)},
          {{"TETRA_20", tet, tet20_lists()}, CGNS_ENUMV(TETRA_20)},
          {{"PENTA_24", wedge, first_of(wedge40_lists(), 18)}, CGNS_ENUMV(PENTA_24)},
          {{"PENTA_38", wedge, first_of(wedge40_lists(), 32)}, CGNS_ENUMV(PENTA_38)},
          {{"PENTA_40", wedge, wedge40_lists()}, CGNS_ENUMV(PENTA_40)},
          {{"PYRA_13", pyramid, pyramid13, CellSpace::linear}, CGNS_ENUMV(PYRA_13)},
          {{"PYRA_14", pyramid, pyramid14}, CGNS_ENUMV(PYRA_14)},
          {{"PYRA_21", pyramid, first_of(pyramid30_lists(), 16)}, CGNS_ENUMV(PYRA_21)},
          {{"PYRA_29", pyramid, first_of(pyramid30_lists(), 24)}, CGNS_ENUMV(PYRA_29)},
          {{"PYRA_30", pyramid, pyramid30_lists()}, CGNS_ENUMV(PYRA_30)},
          {{"PENTA_15", wedge, wedge15}, CGNS_ENUMV(PENTA_15)},
          {{"PENTA_18", wedge, wedge18}, CGNS_ENUMV(PENTA_18)},
          {{"HEXA_20", hexahedron, hex20}, CGNS_ENUMV(HEXA_20)},
          {{"HEXA_27", hexahedron, hex27}, CGNS_ENUMV(HEXA_27)},
          {{"HEXA_32", hexahedron, first_of(hex64_lists(), 24)}, CGNS_ENUMV(HEXA_32)},
          {{"HEXA_56", hexahedron, first_of(hex64_lists(), 48)}, CGNS_ENUMV(HEXA_56)},
          {{"HEXA_64", hexahedron, hex64_lists()}, CGNS_ENUMV(HEXA_64)}};
}

void write_cgns(const std::filesystem::path& file, const BentCell& cell, CGNS_ENUMT(ElementType_t) type,
                bool is_mixed = false) {
  int id = 0, base = 0, zone = 0, made = 0, solution = 0;
  const auto count = static_cast<cgsize_t>(cell.positions.size());
  ASSERT_EQ(cg_open(file.c_str(), CG_MODE_WRITE, &id), CG_OK) << cg_get_error();
  ASSERT_EQ(cg_base_write(id, "base", 3, 3, &base), CG_OK);
  const std::array<cgsize_t, 3> size = {count, 1, 0};
  ASSERT_EQ(cg_zone_write(id, base, "zone", size.data(), CGNS_ENUMV(Unstructured), &zone), CG_OK);
  for (int a = 0; a < 3; ++a) {
    static constexpr std::array<const char*, 3> names = {"CoordinateX", "CoordinateY", "CoordinateZ"};
    std::vector<double> axis;
    for (const glm::dvec3& p : cell.positions) axis.push_back(p[a]);
    ASSERT_EQ(
        cg_coord_write(id, base, zone, CGNS_ENUMV(RealDouble), names[static_cast<std::size_t>(a)], axis.data(), &made),
        CG_OK);
  }
  std::vector<cgsize_t> nodes;
  for (cgsize_t k = 1; k <= count; ++k) nodes.push_back(k);
  if (is_mixed) {
    nodes.insert(nodes.begin(), static_cast<cgsize_t>(type));
    const std::array<cgsize_t, 2> offsets = {0, count + 1};
    ASSERT_EQ(
        cg_poly_section_write(id, base, zone, "cells", CGNS_ENUMV(MIXED), 1, 1, 0, nodes.data(), offsets.data(), &made),
        CG_OK)
        << cg_get_error();
  } else {
    ASSERT_EQ(cg_section_write(id, base, zone, "cells", type, 1, 1, 0, nodes.data(), &made), CG_OK) << cg_get_error();
  }
  ASSERT_EQ(cg_sol_write(id, base, zone, "values", CGNS_ENUMV(Vertex), &solution), CG_OK);
  ASSERT_EQ(cg_field_write(id, base, zone, solution, CGNS_ENUMV(RealDouble), "f", cell.values.data(), &made), CG_OK);
  ASSERT_EQ(cg_close(id), CG_OK);
}

TEST(CurvedCgns, EveryTypeHasItsVolumeAndItsField) {
  TESSERA_VTK_OR_SKIP();
  const test::TemporaryFolder folder;
  const ReadOptions options = testing::coarse_options();
  test::SomeCases some(3);
  for (const auto& [cell, type] : sids_cells()) {
    SCOPED_TRACE(cell.name);
    const BentCell bent = testing::bend(cell);
    for (const bool is_mixed : {false, true}) {
      if (!some.next()) continue;
      write_cgns(folder / "a.cgns", bent, type, is_mixed);
      testing::expect_same(read_mesh(folder / "a.cgns", options), bent);
    }
  }
}

TEST(CurvedCgns, TypesThatAreNotReadAreRefused) {
  TESSERA_VTK_OR_SKIP();
  const test::TemporaryFolder folder;
  BentCell cell = testing::bend({"HEXA_44", cells::CurvedFamily::hexahedron, hex64_lists()});
  cell.positions.resize(44), cell.values.resize(44);
  for (const bool is_mixed : {false, true}) {
    write_cgns(folder / "a.cgns", cell, CGNS_ENUMV(HEXA_44), is_mixed);
    test::expect_bad_input([&] { read_mesh(folder / "a.cgns"); }, {"a.cgns", "has elements HEXA_44", "order 1 to 3"});
  }
}

}  // namespace
}  // namespace tessera::io::curved_cgns_test
