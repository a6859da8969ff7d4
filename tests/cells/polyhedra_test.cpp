// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/mat3x3.hpp>
#include <random>
#include <set>
#include <span>

#include "cells/cell_split.hpp"
#include "cells/mesh_assembly.hpp"
#include "support/mesh_checks.hpp"
#include "support/polyhedral_meshes.hpp"

namespace tessera::io {
namespace {

using testing::agglomerates;
using testing::as_polyhedra;
using testing::count_triangles;
using testing::Faces;
using testing::message_of;
using testing::mixed_mesh;
using testing::polyhedra_of;
using testing::polyominoes;
using testing::voronoi_mesh;

bool on_unit_box(const testing::TrianglePlace& t) {
  for (std::size_t a = 0; a < 3; ++a)
    for (const double wall : {0.0, 1.0})
      if (t[0][a] == wall && t[1][a] == wall && t[2][a] == wall) return true;
  return false;
}

/// Compares the field at a point of the mesh: the largest difference from x + 2 y + 3 z in all tets that contain the
/// point.
double field_error(const scene::TetMesh& mesh, const glm::dvec3& x) {
  double worst = -1;
  for (const scene::Tet& t : mesh.tets) {
    const glm::dvec3 a = mesh.positions[t[0]];
    const glm::dmat3 edges(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a, mesh.positions[t[3]] - a);
    const double volume = glm::dot(glm::cross(edges[0], edges[1]), edges[2]);
    if (std::abs(volume) < 1e-9) continue;
    const glm::dvec3 d = x - a;
    const glm::dvec3 w(glm::dot(glm::cross(d, edges[1]), edges[2]) / volume,
                       glm::dot(glm::cross(edges[0], d), edges[2]) / volume,
                       glm::dot(glm::cross(edges[0], edges[1]), d) / volume);
    if (w.x < 0 || w.y < 0 || w.z < 0 || w.x + w.y + w.z > 1) continue;
    const double value = mesh.scalars[t[0]] * (1 - w.x - w.y - w.z) + mesh.scalars[t[1]] * w.x +
                         mesh.scalars[t[2]] * w.y + mesh.scalars[t[3]] * w.z;
    worst = std::max(worst, std::abs(value - (x.x + 2 * x.y + 3 * x.z)));
  }
  EXPECT_GE(worst, 0) << "no tet holds a point of the box";
  return worst;
}

double area_of(const testing::TrianglePlace& t) {
  const glm::dvec3 a(t[0][0], t[0][1], t[0][2]), b(t[1][0], t[1][1], t[1][2]), c(t[2][0], t[2][1], t[2][2]);
  return glm::length(glm::cross(b - a, c - a)) / 2;
}

/// Inside, every triangle belongs to two tets; triangles of a single tet form the box; the volume is the box's, and the
/// field is linear.
void expect_fills_the_box(const cells::MeshFile& file, unsigned seed, bool has_flat_faces = false) {
  SCOPED_TRACE(fmt::format("seed {}", seed));
  scene::validate(file.mesh, "mesh");
  std::size_t wrong = 0;
  double outside = 0;
  for (const auto& [place, uses] : count_triangles(file.mesh)) {
    if (uses == 1 && on_unit_box(place))
      outside += area_of(place);
    else if (uses % 2 != 0 || (uses != 2 && !has_flat_faces))
      ++wrong;  // flat tets are between the two diagonals of one face of a cell
  }
  EXPECT_EQ(wrong, 0u) << "triangles that not just two tets have";
  EXPECT_NEAR(outside, 6, 1e-11);
  EXPECT_NEAR(testing::volume(file.mesh), 1, 1e-12);  // rounding of about 1e4 determinants
  EXPECT_EQ(file.counts.cells_tangled, 0u);
  EXPECT_EQ(file.counts.cells_open, 0u);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> anywhere(0, 1);
  for (int k = 0; k < 20 && file.mesh.association == scene::Association::point; ++k)
    EXPECT_LT(field_error(file.mesh, {anywhere(random), anywhere(random), anywhere(random)}), 1e-12);
}

cells::MeshFile assemble_f(const cells::CellBlock& block) {
  ReadOptions options;
  options.field = std::string("f");
  return cells::assemble_mesh({block}, options, "mesh");
}

class Polyhedra : public ::testing::TestWithParam<unsigned> {};

TEST_P(Polyhedra, VoronoiCellsFillTheBox) {
  const cells::CellBlock block = voronoi_mesh(60, GetParam());
  const cells::MeshFile file = assemble_f(block);
  expect_fills_the_box(file, GetParam());
  EXPECT_EQ(file.counts.cells_polyhedra, 60u);
}

TEST_P(Polyhedra, JoinedCubesOfAnyShapeFillTheBox) {
  for (const double jitter : {0.0, 0.1, 0.2}) {
    SCOPED_TRACE(jitter);
    const cells::MeshFile file = assemble_f(agglomerates(4, 6, jitter, GetParam()));
    expect_fills_the_box(file, GetParam(), jitter == 0);
    EXPECT_GT(file.counts.polyhedra_from_inside, 0u);
  }
}

TEST_P(Polyhedra, LidsThatAreNotConvexAgree) {
  expect_fills_the_box(assemble_f(polyominoes(5, 3, GetParam())), GetParam());
}

std::multiset<std::vector<std::array<double, 3>>> places_of(const scene::TetMesh& mesh) {
  std::multiset<std::vector<std::array<double, 3>>> all;
  for (const scene::Tet& t : mesh.tets) {
    std::vector<std::array<double, 3>> place;
    for (const std::uint32_t v : t) place.push_back({mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z});
    std::sort(place.begin(), place.end());
    all.insert(place);
  }
  return all;
}

TEST_P(Polyhedra, NativeCellsGivenAsPolyhedraGiveTheSameTets) {
  std::mt19937 random(GetParam());
  cells::CellBlock native = mixed_mesh(4, GetParam(), false);
  const cells::MeshFile cells = assemble_f(native), polyhedra = assemble_f(as_polyhedra(native, random));
  EXPECT_EQ(places_of(cells.mesh), places_of(polyhedra.mesh));
  EXPECT_EQ(polyhedra.counts.cells_polyhedra, native.types.size());
  EXPECT_EQ(polyhedra.counts.polyhedra_from_inside, 0u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Polyhedra, ::testing::Range(1u, 9u));

TEST(PolyhedronCells, FacesWithCornersOnTheirEdgesLeaveNoHoles) {
  // A slab under four columns: points on its edges and within its top, which consists of four coplanar faces.
  std::mt19937 random(1);
  std::vector<glm::dvec3> p;
  const auto at = [&](double x, double y, double z) {
    const glm::dvec3 place(x, y, z);
    const auto found = std::find(p.begin(), p.end(), place);
    if (found != p.end()) return static_cast<std::uint32_t>(found - p.begin());
    p.push_back(place);
    return static_cast<std::uint32_t>(p.size() - 1);
  };
  Faces slab;
  std::vector<Faces> cells;
  for (const double x : {0.0, 0.5})
    for (const double y : {0.0, 0.5}) {
      const std::uint32_t a = at(x, y, 0.5), b = at(x + 0.5, y, 0.5), c = at(x + 0.5, y + 0.5, 0.5),
                          d = at(x, y + 0.5, 0.5);
      const std::uint32_t e = at(x, y, 1), f = at(x + 0.5, y, 1), g = at(x + 0.5, y + 0.5, 1), h = at(x, y + 0.5, 1);
      cells.push_back({{a, d, c, b}, {e, f, g, h}, {a, b, f, e}, {b, c, g, f}, {c, d, h, g}, {d, a, e, h}});
      slab.push_back({a, b, c, d});
    }
  const auto ring = [&](double z) {
    return std::vector<std::uint32_t>{at(0, 0, z), at(1, 0, z), at(1, 1, z), at(0, 1, z)};
  };
  const auto low = ring(0), high = ring(0.5);
  const std::vector<std::uint32_t> middles = {at(0.5, 0, 0.5), at(1, 0.5, 0.5), at(0.5, 1, 0.5), at(0, 0.5, 0.5)};
  for (std::size_t k = 0; k < 4; ++k)
    slab.push_back({low[k], low[(k + 1) % 4], high[(k + 1) % 4], middles[k], high[k]});
  slab.push_back(low);
  cells.push_back(slab);
  expect_fills_the_box(assemble_f(polyhedra_of(p, cells, random)), 1, true);
}

TEST(PolyhedronCells, InSeveralBlocksAgreeByPosition) {
  for (unsigned seed = 1; seed < 4; ++seed) {
    const cells::CellBlock whole = agglomerates(4, 5, 0.15, seed);
    const std::vector<Faces> all = testing::faces_of_cells(whole);
    std::vector<cells::CellBlock> blocks;
    std::mt19937 random(seed);
    for (const std::size_t first : {0, 1}) {
      std::vector<Faces> cells;
      for (std::size_t c = first; c < all.size(); c += 2) cells.push_back(all[c]);
      blocks.push_back(polyhedra_of(whole.positions, cells, random));
    }
    ReadOptions options;
    options.field = std::string("f");
    expect_fills_the_box(cells::assemble_mesh(blocks, options, "mesh"), seed);
  }
}

TEST(PolyhedronCells, MeetHexahedraWedgesAndPyramids) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    std::mt19937 random(seed);
    const cells::CellBlock native = mixed_mesh(5, seed, false);
    cells::CellBlock some = as_polyhedra(native, random);
    for (std::size_t c = 0; c < some.types.size(); ++c) some.types[c] = random() % 2 == 0 ? 42 : 0;
    cells::CellBlock others = native;
    for (std::size_t c = 0; c < some.types.size(); ++c)
      if (some.types[c] != 0) others.types[c] = 1;  // skipped there
    for (std::uint8_t& type : some.types) type = type == 0 ? 1 : type;
    ReadOptions options;
    options.field = std::string("f");
    expect_fills_the_box(cells::assemble_mesh({some, others}, options, "mesh"), seed);
  }
}

TEST(PolyhedronCells, HexahedraNotVisibleFromTheirSmallestCornerAreSplitDifferently) {
  int overlapping = 0;
  for (unsigned seed = 1; seed < 6; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> move(-0.25, 0.25);
    constexpr std::uint32_t n = 5, u = n + 1, w = u * u;
    cells::CellBlock block;
    block.offsets.push_back(0);
    std::vector<double> f;
    for (std::uint32_t v = 0; v < w * u; ++v) {
      glm::dvec3 p(v % u, v / u % u, v / w);
      for (int a = 0; a < 3; ++a)
        if (p[a] > 0 && p[a] < n) p[a] += move(random);
      block.positions.push_back(p / static_cast<double>(n));
      f.push_back(glm::dot(block.positions.back(), glm::dvec3(1, 2, 3)));
    }
    block.fields.push_back(cells::field_of_values("f", "double", scene::Association::point, 1, std::move(f)));
    for (std::uint32_t v = 0; v < w * u; ++v) {
      if (v % u == n || v / u % u == n || v / w == n) continue;
      for (const std::uint32_t corner : {v, v + 1, v + 1 + u, v + u, v + w, v + w + 1, v + w + 1 + u, v + w + u})
        block.connectivity.push_back(corner);
      block.types.push_back(12);
      block.offsets.push_back(block.connectivity.size());
    }
    const cells::MeshFile file = assemble_f(block);
    // Counts the cells whose tets would overlap if every cell were split from its smallest corner.
    for (std::size_t c = 0; c < block.types.size(); ++c) {
      scene::TetMesh cone;
      cone.positions = block.positions;
      cells::split_cell(cells::CellKind::hexahedron, std::span(block.connectivity).subspan(8 * c, 8), block.positions,
                        cone.tets);
      double sum = 0;
      for (const scene::Tet& t : cone.tets) {
        const glm::dvec3 a = block.positions[t[0]];
        sum += glm::dot(glm::cross(block.positions[t[1]] - a, block.positions[t[2]] - a), block.positions[t[3]] - a);
      }
      overlapping += 6 * testing::volume(cone) > 1.00001 * std::abs(sum) ? 1 : 0;
    }
    EXPECT_EQ(file.counts.cells_polyhedra, 0u);
    expect_fills_the_box(file, seed);
    std::mt19937 again(seed);
    EXPECT_EQ(places_of(assemble_f(as_polyhedra(block, again)).mesh), places_of(file.mesh));
  }
  EXPECT_GT(overlapping, 0);
}

}  // namespace
}  // namespace tessera::io
