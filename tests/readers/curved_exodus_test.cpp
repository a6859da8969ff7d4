// SPDX-License-Identifier: BSD-3-Clause
// Cells of second order in Exodus files, written by the Exodus library in the order of the Exodus manual.
#include <gtest/gtest.h>
#include <vtk_exodusII.h>

#include <glm/geometric.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "cells/mesh_assembly.hpp"
#include "io/mesh/block_surface.hpp"
#include "support/curved_reference.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/some_cases.hpp"
#include "support/temporary_folder.hpp"
#include "support/vtk_or_skip.hpp"

namespace tessera::io::curved_exodus_test {
namespace {

using testing::BentCell;
using testing::CellSpace;
using testing::ReferenceCell;
using Lists = std::vector<std::vector<int>>;

template <class... More>
Lists together(Lists first, const More&... more) {
  (first.insert(first.end(), more.begin(), more.end()), ...);
  return first;
}

const Lists base_edges = {{1, 2}, {2, 3}, {3, 4}, {4, 1}}, top_edges = {{5, 6}, {6, 7}, {7, 8}, {8, 5}},
            upright_edges = {{1, 5}, {2, 6}, {3, 7}, {4, 8}}, hexahedron_inside = {{1, 2, 3, 4, 5, 6, 7, 8}},
            hexahedron_faces = {{1, 2, 3, 4}, {5, 6, 7, 8}, {1, 4, 8, 5}, {2, 3, 7, 6}, {1, 2, 6, 5}, {3, 4, 8, 7}};
const Lists tet_edges = {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 4}, {3, 4}}, tet_inside = {{1, 2, 3, 4}},
            tet_faces = {{1, 2, 3}, {2, 3, 4}, {1, 3, 4}, {1, 2, 4}};
const Lists wedge_base = {{1, 2}, {2, 3}, {3, 1}}, wedge_top = {{4, 5}, {5, 6}, {6, 4}},
            wedge_upright = {{1, 4}, {2, 5}, {3, 6}}, wedge_inside = {{1, 2, 3, 4, 5, 6}},
            wedge_triangles = {{1, 2, 3}, {4, 5, 6}}, wedge_sides = {{1, 2, 5, 4}, {2, 3, 6, 5}, {1, 4, 6, 3}},
            wedge_sides_after_triangles = {{2, 3, 6, 5}, {1, 4, 6, 3}, {1, 2, 5, 4}};
const Lists pyramid_edges = {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 5}, {2, 5}, {3, 5}, {4, 5}},
            pyramid_base = {{1, 2, 3, 4}}, pyramid_triangles = {{1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {4, 1, 5}},
            pyramid_inside = {{1, 2, 3, 4, 5}};

/// Patran's hexahedron of third order: corners, edges, then the remaining nodes of each of four levels, base to top.
ReferenceCell hex64() {
  using testing::a_third, testing::near_first;
  Lists lists;
  const auto add_edges = [&](const Lists& edges) {
    for (const std::vector<int>& edge : edges)
      lists.push_back(a_third(edge[0], edge[1])), lists.push_back(a_third(edge[1], edge[0]));
  };
  add_edges(base_edges);
  for (const std::vector<int>& edge : upright_edges) lists.push_back(a_third(edge[0], edge[1]));
  for (const std::vector<int>& edge : upright_edges) lists.push_back(a_third(edge[1], edge[0]));
  add_edges(top_edges);
  for (int k = 0; k < 4; ++k) lists.push_back(near_first({k + 1, (k + 1) % 4 + 1, (k + 2) % 4 + 1, (k + 3) % 4 + 1}));
  for (const int level : {0, 4}) {
    const int other = 4 - level;
    for (int k = 0; k < 4; ++k) {
      const int a = k + 1, b = (k + 1) % 4 + 1;
      lists.push_back(near_first({a + level, b + level, b + other, a + other}));
      lists.push_back(near_first({b + level, a + level, a + other, b + other}));
    }
    for (int k = 1; k <= 4; ++k) lists.push_back(testing::near_corner_of_hexahedron(k + level));
  }
  for (int k = 0; k < 4; ++k) lists.push_back(near_first({k + 5, (k + 1) % 4 + 5, (k + 2) % 4 + 5, (k + 3) % 4 + 5}));
  return {"HEX64", cells::CurvedFamily::hexahedron, lists};
}

/// Cells of third order with nodes only on their edges: on vertical edges the lower ones come first.
Lists cubic_edges(const Lists& base, const Lists& upright, const Lists& top) {
  Lists lists;
  const auto add = [&](const Lists& edges) {
    for (const std::vector<int>& edge : edges)
      lists.push_back(testing::a_third(edge[0], edge[1])), lists.push_back(testing::a_third(edge[1], edge[0]));
  };
  add(base);
  for (const std::vector<int>& edge : upright) lists.push_back(testing::a_third(edge[0], edge[1]));
  for (const std::vector<int>& edge : upright) lists.push_back(testing::a_third(edge[1], edge[0]));
  add(top);
  return lists;
}

std::vector<ReferenceCell> manual_cells() {
  constexpr auto hexahedron = cells::CurvedFamily::hexahedron, tet = cells::CurvedFamily::tet,
                 wedge = cells::CurvedFamily::wedge, pyramid = cells::CurvedFamily::pyramid;
  const Lists hex20 = together(base_edges, upright_edges, top_edges),
              wedge15 = together(wedge_base, wedge_upright, wedge_top);
  return {
      {"HEX9", hexahedron, hexahedron_inside, CellSpace::linear},
      {"HEX16", hexahedron, together(base_edges, top_edges), CellSpace::quadratic_in_r_s},
      {"HEX20", hexahedron, hex20},
      {"hex21", hexahedron, together(hex20, hexahedron_inside)},
      {"HEX", hexahedron, together(hex20, hexahedron_inside, hexahedron_faces)},
      {"HEX32", hexahedron, cubic_edges(base_edges, upright_edges, top_edges)},
      hex64(),
      {"TETRA5", tet, tet_inside, CellSpace::linear},
      {"TETRA8", tet, {{1, 2, 4}, {2, 3, 4}, {1, 2, 3}, {1, 3, 4}}, CellSpace::linear},
      {"TETRA10", tet, tet_edges},
      {"tet11", tet, together(tet_edges, tet_inside)},
      {"TETRA14", tet, together(tet_edges, tet_faces)},
      {"TETRA15", tet, together(tet_edges, tet_inside, tet_faces)},
      {"TETRA", tet, together(tet_edges, tet_faces, tet_inside)},  // as in the library's own side sets
      {"TETRA16", tet, cubic_edges(wedge_base, {{1, 4}, {2, 4}, {3, 4}}, {})},
      {"WEDGE12", wedge, together(wedge_base, wedge_top), CellSpace::quadratic_in_r_s},
      {"WEDGE15", wedge, wedge15},
      {"WEDGE16", wedge, together(wedge15, wedge_inside)},
      {"Wedge", wedge, together(wedge15, wedge_sides)},
      {"WEDGE20", wedge, together(wedge15, wedge_triangles, wedge_sides_after_triangles)},
      {"WEDGE21", wedge, together(wedge15, wedge_inside, wedge_triangles, wedge_sides_after_triangles)},
      {"WEDGE", wedge, together(wedge15, wedge_triangles, wedge_inside, wedge_sides_after_triangles)},  // as in Ioss
      {"WEDGE24", wedge, cubic_edges(wedge_base, wedge_upright, wedge_top)},
      {"PYRAMID13", pyramid, pyramid_edges, CellSpace::linear},
      {"PYRAMID14", pyramid, together(pyramid_edges, pyramid_base)},
      {"pyramid", pyramid, together(pyramid_edges, pyramid_base, pyramid_triangles)},
      {"PYRAMID19", pyramid, together(pyramid_edges, pyramid_base, pyramid_triangles, pyramid_inside)}};
}

/// One block of `count` cells, each with its own nodes, along x.
void write_exodus(const std::string& name, const std::string& topology, const BentCell& cell, int sides = 0,
                  int cells = 1) {
  int word = sizeof(double), stored = sizeof(double);
  const int id = ex_create(name.c_str(), EX_CLOBBER, &word, &stored);
  ASSERT_GE(id, 0);
  const int each = static_cast<int>(cell.positions.size()), count = cells * each;
  ex_init_params init{};
  init.num_dim = 3;
  init.num_nodes = count;
  init.num_elem = cells;
  init.num_elem_blk = 1;
  init.num_side_sets = sides > 0 ? 1 : 0;
  ex_put_init_ext(id, &init);
  std::vector<double> x, y, z, values;
  std::vector<int> nodes;
  for (int c = 0; c < cells; ++c) {
    for (const glm::dvec3& p : cell.positions) x.push_back(p.x + 5 * c), y.push_back(p.y), z.push_back(p.z);
    values.insert(values.end(), cell.values.begin(), cell.values.end());
  }
  for (int k = 1; k <= count; ++k) nodes.push_back(k);
  ex_put_coord(id, x.data(), y.data(), z.data());
  ex_put_block(id, EX_ELEM_BLOCK, 3, topology.c_str(), cells, each, 0, 0, 0);
  ex_put_conn(id, EX_ELEM_BLOCK, 3, nodes.data(), nullptr, nullptr);
  if (sides > 0) {
    std::vector<int> elements(static_cast<std::size_t>(sides), cells), numbers;
    for (int k = 1; k <= sides; ++k) numbers.push_back(k);
    ex_put_set_param(id, EX_SIDE_SET, 1, sides, 0);
    ex_put_set(id, EX_SIDE_SET, 1, elements.data(), numbers.data());
    ex_put_name(id, EX_SIDE_SET, 1, "skin");
  }
  ex_put_variable_param(id, EX_NODAL, 1);
  ex_put_variable_name(id, EX_NODAL, 1, "f");
  const double time = 0;
  ex_put_time(id, 1, &time);
  ex_put_var(id, 1, EX_NODAL, 1, 1, count, values.data());
  ASSERT_EQ(ex_close(id), EX_NOERR);
}

cells::MeshFile read_back(const std::string& topology, const BentCell& cell, int cells = 1,
                          double tolerance = testing::coarse_options().higher_order_tolerance) {
  const test::TemporaryFolder folder;
  write_exodus((folder / "a.exo").string(), topology, cell, 0, cells);
  ReadOptions options = testing::coarse_options();
  options.higher_order_tolerance = tolerance;
  return read_mesh(folder / "a.exo", options);
}

TEST(CurvedExodus, EveryTypeOfTheManualHasItsVolumeAndItsField) {
  TESSERA_VTK_OR_SKIP();
  test::SomeCases some(3);
  for (const ReferenceCell& cell : manual_cells()) {
    if (!some.next()) continue;
    SCOPED_TRACE(cell.name);
    const BentCell bent = testing::bend(cell);
    testing::expect_same(read_back(cell.name, bent, 3), bent, 3);
  }
}

TEST(CurvedExodus, ANodeInATrianglesMiddleBendsIt) {
  TESSERA_VTK_OR_SKIP();
  // The function of the node in a triangle's middle is 27 L1 L2 L3. Its integral over a triangle is 9/20 of the area.
  const ReferenceCell tet8{
      "TETRA8", cells::CurvedFamily::tet, {{1, 2, 4}, {2, 3, 4}, {1, 2, 3}, {1, 3, 4}}, CellSpace::linear};
  BentCell bent{testing::places_of(tet8), std::vector<double>(8, 1), 1.0 / 6 + 0.45 * 0.5 * 0.1, 0};
  bent.positions[6].z -= 0.1;  // of the base
  bent.integral = bent.volume;
  testing::expect_same(read_back("TETRA8", bent), bent);
}

TEST(CurvedExodus, ANodeInsideChangesTheFieldAndNotTheShape) {
  TESSERA_VTK_OR_SKIP();
  // The field is 1 at the middle node of a cell and 0 at the others. Its integral over a cube is that of 64 r (1 - r) s
  // (1 - s) t (1 - t); over a tetrahedron, that of 256 L1 L2 L3 L4, which is 256 / 7!.
  const ReferenceCell hex9{"HEX9", cells::CurvedFamily::hexahedron, hexahedron_inside, CellSpace::linear},
      tet11{"TETRA11", cells::CurvedFamily::tet, together(tet_edges, tet_inside)};
  for (const auto& [cell, volume, integral] :
       {std::tuple(hex9, 1.0, 64.0 / 216), std::tuple(tet11, 1.0 / 6, 256.0 / 5040)}) {
    SCOPED_TRACE(cell.name);
    BentCell bent{testing::places_of(cell), {}, volume, integral};
    bent.values.assign(bent.positions.size(), 0);
    bent.values.back() = 1;
    const cells::MeshFile read = read_back(cell.name, bent, 1, 1e-2);
    EXPECT_NEAR(testing::volume(read.mesh), volume, 1e-12);
    EXPECT_LT(read.higher_order.field_error, 0.02);
    EXPECT_NEAR(testing::field_integral(read.mesh), integral, read.higher_order.field_error * volume);
  }
}

TEST(CurvedExodus, CellsWithoutAPublishedOrderAreDrawnByTheirCorners) {
  TESSERA_VTK_OR_SKIP();
  for (const auto& [name, shape, nodes] :
       {std::tuple("TETRA40", cells::CurvedFamily::tet, 40u), std::tuple("WEDGE52", cells::CurvedFamily::wedge, 52u)}) {
    SCOPED_TRACE(name);
    ReferenceCell cell{name, shape, {}};
    while (testing::places_of(cell).size() < nodes) cell.middles.push_back({1, 2, 3});
    BentCell plane{testing::places_of(cell), {}, 0, 0};
    plane.values.assign(plane.positions.size(), 1);
    const cells::MeshFile read = read_back(name, plane);
    EXPECT_NEAR(testing::volume(read.mesh), shape == cells::CurvedFamily::tet ? 1.0 / 6 : 0.5, 1e-12);
    EXPECT_EQ(read.higher_order.by_corners, 1u);
    const std::vector<std::string> warnings = cells::warnings_on_cells(read.counts, read.higher_order);
    ASSERT_FALSE(warnings.empty());
    EXPECT_NE(warnings.front().find("rendered as linear cells with the same corners"), std::string::npos);
  }
}

TEST(CurvedExodus, SidesOfEveryTypeCloseItsCorners) {
  TESSERA_VTK_OR_SKIP();
  const test::TemporaryFolder folder;
  test::SomeCases some(3);
  for (const ReferenceCell& cell : manual_cells()) {
    if (!some.next()) continue;
    SCOPED_TRACE(cell.name);
    BentCell plane{testing::places_of(cell), {}, 0, 0};
    plane.values.assign(plane.positions.size(), 1);
    const int sides = cell.shape == cells::CurvedFamily::tet          ? 4
                      : cell.shape == cells::CurvedFamily::hexahedron ? 6
                                                                      : 5;
    write_exodus((folder / "a.exo").string(), cell.name, plane, sides, 2);
    ReadOptions options;
    options.blocks = {"skin"};
    const BlockFaces faces = read_block_faces(std::vector<std::filesystem::path>{folder / "a.exo"}, options);
    double six_volumes = 0;
    for (const auto& t : faces.mesh.triangles) {
      const auto& p = faces.mesh.points;
      six_volumes += glm::dot(p[t[0]], glm::cross(p[t[1]], p[t[2]]));
    }
    const double volume = cell.shape == cells::CurvedFamily::tet          ? 1.0 / 6
                          : cell.shape == cells::CurvedFamily::hexahedron ? 1
                          : cell.shape == cells::CurvedFamily::wedge      ? 0.5
                                                                          : 1.0 / 3;
    EXPECT_NEAR(std::abs(six_volumes) / 6, volume, 1e-12);
  }
}

}  // namespace
}  // namespace tessera::io::curved_exodus_test
