// SPDX-License-Identifier: BSD-3-Clause
#include "cells/polyhedron_split.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "cells/mesh_assembly.hpp"
#include "scene/threads.hpp"
#include "support/mesh_checks.hpp"
#include "support/polyhedral_meshes.hpp"

namespace tessera::io {
namespace {

using testing::agglomerates;
using testing::Faces;
using testing::polyhedra_of;
using testing::voronoi_mesh;

bool comes_before(const glm::dvec3& a, const glm::dvec3& b) {
  return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
}

cells::MeshFile assembled(const cells::CellBlock& block, const std::string& field = "f", int threads = 0) {
  ReadOptions options;
  options.field = field;
  cells::MeshFile file = scene::with_threads(threads, [&] {
    return cells::assemble_mesh({block, block}, options, "mesh");
  });
  file.counts.cells_duplicate = 0;  // the second block is on top of the first, which does not matter here
  return file;
}

/// The faces of a cube as one polyhedron, with points from index `first` on.
Faces cube_faces(std::uint32_t first = 0) {
  Faces faces = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}};
  for (auto& face : faces)
    for (std::uint32_t& corner : face) corner += first;
  return faces;
}
std::vector<glm::dvec3> cube_points(double x = 0) {
  return {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}, {x, 0, 1}, {x + 1, 0, 1}, {x + 1, 1, 1}, {x, 1, 1}};
}

/// The triangles of a face whose corners are numbered by position and are listed from a random start, in either
/// direction.
std::set<testing::TrianglePlace> triangles_of(const std::vector<glm::dvec3>& outline, std::mt19937& random) {
  std::vector<glm::dvec3> p = outline;
  std::sort(p.begin(), p.end(), comes_before);
  std::vector<std::uint32_t> corners;
  for (const glm::dvec3& x : outline)
    corners.push_back(static_cast<std::uint32_t>(std::find(p.begin(), p.end(), x) - p.begin()));
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(random() % corners.size()), corners.end());
  if (random() % 2 == 0) std::reverse(corners.begin(), corners.end());
  std::vector<cells::CornerTriangle> triangles;
  cells::FaceCutter().cut(corners, p, triangles);
  EXPECT_EQ(triangles.size(), outline.size() - 2);
  std::set<testing::TrianglePlace> places;
  for (const cells::CornerTriangle& t : triangles) {
    testing::TrianglePlace place;
    for (std::size_t k = 0; k < 3; ++k) place[k] = {p[t[k]].x, p[t[k]].y, p[t[k]].z};
    std::sort(place.begin(), place.end());
    places.insert(place);
  }
  return places;
}

double area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return glm::length(glm::cross(b - a, c - a)) / 2;
}

TEST(FaceTriangles, DependOnNeitherTheStartNorTheOrderOfTheCorners) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> radius(0.2, 1), warp(-0.1, 0.1);
  int ears = 0;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(fmt::format("round {}", round));
    const int n = 4 + static_cast<int>(random() % 9);
    const bool is_convex = round % 3 == 0, is_plane = round % 2 == 0;
    std::vector<glm::dvec3> outline;
    double whole = 0;
    for (int k = 0; k < n; ++k) {  // a star around the origin
      const double angle = 2 * 3.141592653589793 * k / n, r = is_convex ? 1 : radius(random), x = r * std::cos(angle);
      outline.emplace_back(x, r * std::sin(angle), is_plane ? 0.3 * x : warp(random));
    }
    for (std::size_t k = 0; k < outline.size(); ++k)
      whole += area(glm::dvec3(0), outline[k], outline[(k + 1) % outline.size()]);
    const auto triangles = triangles_of(outline, random);
    for (int again = 0; again < 10; ++again) EXPECT_EQ(triangles_of(outline, random), triangles);

    double covered = 0;
    const glm::dvec3 smallest = *std::min_element(outline.begin(), outline.end(), comes_before);
    bool is_fan = true;
    for (const auto& t : triangles) {
      const auto place = [&](std::size_t k) { return glm::dvec3(t[k][0], t[k][1], t[k][2]); };
      covered += area(place(0), place(1), place(2));
      is_fan = is_fan && place(0) == smallest;
    }
    if (is_plane) {
      EXPECT_NEAR(covered, whole, 1e-12) << "triangles overlap";
    }
    if (is_convex) {
      EXPECT_TRUE(is_fan);
    }
    ears += is_fan ? 0 : 1;
  }
  EXPECT_GT(ears, 50);
}

TEST(FaceTriangles, OfAFaceWithCornersOnItsEdgesKeepThemAll) {
  std::mt19937 random(2);
  const std::vector<glm::dvec3> outline = {{0, 0, 0},     {0.25, 0, 0}, {0.5, 0, 0}, {1, 0, 0},
                                           {1, 0.125, 0}, {1, 1, 0},    {0, 1, 0},   {0, 0.5, 0}};
  const auto triangles = triangles_of(outline, random);
  std::map<std::pair<testing::Point, testing::Point>, int> edges;
  for (const auto& t : triangles)
    for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}})
      ++edges[{t[static_cast<std::size_t>(a)], t[static_cast<std::size_t>(b)]}];
  for (std::size_t k = 0; k < outline.size(); ++k) {
    auto ends = std::minmax(outline[k], outline[(k + 1) % outline.size()], comes_before);
    EXPECT_EQ((edges[{{ends.first.x, ends.first.y, ends.first.z}, {ends.second.x, ends.second.y, ends.second.z}}]), 1);
  }
}

TEST(PolyhedronSplit, AcceptsFacesOfAnyOrientation) {
  for (unsigned seed = 1; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const cells::MeshFile file = assembled(polyhedra_of(cube_points(), {cube_faces()}, random));
    EXPECT_EQ(file.mesh.tets.size(), 2 * 6u);
    EXPECT_DOUBLE_EQ(testing::volume(file.mesh), 2);
  }
}

TEST(PolyhedronSplit, OmitsOpenPolyhedraWithAWarning) {
  std::mt19937 random(1);
  std::vector<glm::dvec3> p = cube_points();
  for (const glm::dvec3& x : cube_points(2)) p.push_back(x);
  Faces open = cube_faces(8), doubled = open;
  open.pop_back();
  doubled.push_back(doubled.front());
  for (const Faces& bad : {open, doubled, Faces{}}) {
    const cells::MeshFile file = assembled(polyhedra_of(p, {bad, cube_faces()}, random));
    EXPECT_EQ(file.counts.cells_open, 2u);
    EXPECT_EQ(file.counts.cells_polyhedra, 2u);
    EXPECT_DOUBLE_EQ(testing::volume(file.mesh), 2);
    ASSERT_EQ(cells::warnings_on_cells(file.counts, {}).size(), 1u);
    EXPECT_EQ(cells::warnings_on_cells(file.counts, {})[0],
              "2 polyhedra are left out: their faces do not form a closed surface");
  }
  test::expect_bad_input([&] { assembled(polyhedra_of(p, {open}, random)); }, {"2 are polyhedra whose faces do not"});
}

TEST(PolyhedronSplit, CutsPolyhedraThatNoPointSeesWhole) {
  // A U of five unit squares, of height one: no point sees all of it.
  std::vector<glm::dvec3> p;
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : {std::pair{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}})
      p.emplace_back(x, y, z);
  Faces faces(2);
  for (std::uint32_t k = 0; k < 8; ++k) {
    faces[0].insert(faces[0].begin(), k);
    faces[1].push_back(k + 8);
    faces.push_back({k, (k + 1) % 8, (k + 1) % 8 + 8, k + 8});
  }
  std::mt19937 random(1);
  const cells::MeshFile file = assembled(polyhedra_of(p, {faces}, random));
  EXPECT_EQ(file.counts.polyhedra_in_pieces, 2u);
  EXPECT_NEAR(testing::volume(file.mesh), 10, 1e-13);
  EXPECT_TRUE(cells::warnings_on_cells(file.counts, {}).empty());
}

TEST(PolyhedronSplit, AddsAPointWhereCornersAloneAllowNoTets) {
  // Schoenhardt's polyhedron (1928): a prism over a triangle, twisted by 30 degrees until its side faces bend inward.
  std::vector<glm::dvec3> p;
  for (const double turn : {0.0, 1.0})
    for (int k = 0; k < 3; ++k) {
      const double angle = 3.141592653589793 * (2.0 / 3 * k + turn / 6);
      p.emplace_back(std::cos(angle), std::sin(angle), turn);
    }
  Faces faces = {{0, 2, 1}, {3, 4, 5}};
  double signed6 = 0;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t next = (k + 1) % 3;
    faces.push_back({k, next, next + 3});
    faces.push_back({k, next + 3, k + 3});
  }
  for (const auto& face : faces) signed6 += glm::dot(glm::cross(p[face[0]], p[face[1]]), p[face[2]]);
  std::mt19937 random(1);
  const cells::MeshFile file = assembled(polyhedra_of(p, {faces}, random));
  EXPECT_EQ(file.counts.polyhedra_from_inside, 2u);
  EXPECT_NEAR(testing::volume(file.mesh), 2 * signed6 / 6, 1e-13);
}

TEST(PolyhedronSplit, WarnsOfOverlappingTetsWhereItCannotSplit) {
  // A cube with a smaller cube cut out inside.
  std::vector<glm::dvec3> p = cube_points();
  for (const glm::dvec3& x : cube_points()) p.push_back(0.5 * x + glm::dvec3(0.25));
  Faces faces = cube_faces(), inner = cube_faces(8);
  for (auto& face : inner) std::reverse(face.begin(), face.end());
  faces.insert(faces.end(), inner.begin(), inner.end());
  std::mt19937 random(1);
  const cells::MeshFile file = assembled(polyhedra_of(p, {faces}, random, true));
  EXPECT_EQ(file.counts.polyhedra_tangled, 2u);
  EXPECT_EQ(file.counts.cells_tangled, 2u);
  ASSERT_EQ(cells::warnings_on_cells(file.counts, {}).size(), 1u);
  EXPECT_NE(cells::warnings_on_cells(file.counts, {})[0].find("2 polyhedra are drawn by tets that overlap"),
            std::string::npos);
}

TEST(PolyhedronSplit, FindsAPointInsideWhereCornersAndTheirMeanDoNot) {
  // A prism whose ends are a square with a deep notch and many corners at one end, so that their mean is outside.
  const std::vector<std::pair<double, double>> outline = {{0, 0},      {4, 0}, {4, 0.9},    {3.99, 0.95}, {4, 1},
                                                          {3.99, 1.5}, {4, 2}, {3.99, 2.5}, {4, 3},       {3.99, 3.5},
                                                          {4, 4},      {0, 4}, {0, 2.2},    {2.5, 2},     {0, 1.8}};
  std::vector<glm::dvec3> p;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : outline) p.emplace_back(x, y, z);
  Faces faces(2);
  double twice = 0;
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    faces[0].insert(faces[0].begin(), k);
    faces[1].push_back(k + n);
    faces.push_back({k, next, next + n, k + n});
    twice += outline[k].first * outline[next].second - outline[next].first * outline[k].second;
  }
  std::mt19937 random(1);
  const cells::MeshFile file = assembled(polyhedra_of(p, {faces}, random));
  EXPECT_NEAR(testing::volume(file.mesh), twice, 1e-12);
  for (std::size_t v = 0; v < file.mesh.positions.size(); ++v) {
    const glm::dvec3& x = file.mesh.positions[v];
    EXPECT_NEAR(file.mesh.scalars[v], x.x + 2 * x.y + 3 * x.z, 1e-13);
  }
}

TEST(PolyhedronSplit, FollowsTheRulesForGhostsHiddenPointsAndNan) {
  cells::CellBlock block = voronoi_mesh(40, 3);
  block.cell_ghost.assign(40, 0);
  block.cell_ghost[3] = 1, block.cell_ghost[4] = 32;
  cells::MeshFile file = assembled(block);
  EXPECT_EQ(file.counts.cells_ghost, 2u);
  EXPECT_EQ(file.counts.cells_hidden, 2u);
  EXPECT_EQ(file.counts.cells_polyhedra, 76u);
  block.cell_ghost.clear();
  block.point_ghost.assign(block.positions.size(), 0);
  const std::uint32_t corner = block.faces.back();
  block.point_ghost[corner] = 2;
  const std::uint64_t hidden = assembled(block).counts.cells_hidden;
  EXPECT_GE(hidden, 2u);
  block.point_ghost.clear();
  block.positions[corner].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(assembled(block).counts.cells_nan, hidden);
}

TEST(PolyhedronSplit, KeepsOneValueACellOfCellData) {
  const cells::MeshFile file = assembled(agglomerates(3, 5, 0.2, 4), "c");
  scene::validate(file.mesh, "mesh");
  EXPECT_GT(file.counts.polyhedra_from_inside, 0u);
  ASSERT_EQ(file.mesh.scalars.size(), file.mesh.tets.size());
  const std::uint64_t cells = file.counts.cells_read / 2;
  for (std::size_t t = 0; t < file.mesh.tets.size(); ++t)
    ASSERT_EQ(file.mesh.scalars[t], static_cast<double>(file.mesh.original_cell[t] % cells));
}

TEST(PolyhedronSplit, GivesTheSameMeshWithAnyThreads) {
  // More cells than a thread takes at a time, with added points in between.
  std::mt19937 random(1);
  std::vector<glm::dvec3> p;
  std::vector<Faces> cells;
  const cells::CellBlock shapes = agglomerates(3, 5, 0.2, 2);
  const std::vector<Faces> shape = testing::faces_of_cells(shapes);
  for (std::uint32_t k = 0; k < 20'000; ++k) {
    if (k % 100 == 0) {
      const auto first = static_cast<std::uint32_t>(p.size());
      for (const glm::dvec3& x : shapes.positions) p.push_back(x + glm::dvec3(2.0 * k, -2, 0));
      for (Faces faces : shape) {
        for (auto& face : faces)
          for (std::uint32_t& v : face) v += first;
        cells.push_back(std::move(faces));
      }
    }
    const auto first = static_cast<std::uint32_t>(p.size());
    for (const glm::dvec3& x : cube_points(2.0 * k)) p.push_back(x);
    cells.push_back(cube_faces(first));
  }
  const cells::CellBlock block = polyhedra_of(p, cells, random);
  const cells::MeshFile one = assembled(block, "f", 1), two = assembled(block, "f", 2);
  scene::validate(one.mesh, "mesh");
  EXPECT_NEAR(testing::volume(one.mesh), 2 * (20'000 + 200), 1e-6);
  for (std::size_t v = 0; v < one.mesh.positions.size(); ++v) {
    const glm::dvec3& x = one.mesh.positions[v];
    ASSERT_NEAR(one.mesh.scalars[v], x.x + 2 * x.y + 3 * x.z, 1e-9) << v;
  }
  EXPECT_EQ(one.mesh.tets, two.mesh.tets);
  EXPECT_EQ(one.mesh.positions, two.mesh.positions);
  EXPECT_EQ(one.mesh.scalars, two.mesh.scalars);
  EXPECT_EQ(one.counts, two.counts);
}

TEST(PolyhedronSplit, CutsPrismsWithHollowLidsAsPolyhedra) {
  // A hexagonal prism with a corner pushed in, given as type 16, on top of one given as a polyhedron.
  std::vector<glm::dvec3> p;
  for (const double z : {0.0, 1.0, 2.0})
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}, {1.0, 2.0}, {0.9, 0.4}, {0.0, 2.0}})
      p.emplace_back(x, y, z);
  Faces faces(2);
  for (std::uint32_t k = 0; k < 6; ++k) {
    faces[0].push_back(k + 6), faces[1].push_back(k + 12);
    faces.push_back({k + 6, (k + 1) % 6 + 6, (k + 1) % 6 + 12, k + 12});
  }
  std::mt19937 random(1);
  cells::CellBlock block = polyhedra_of(p, {faces}, random);
  block.types.push_back(16);
  for (std::uint32_t k = 0; k < 12; ++k) block.connectivity.push_back(k);
  block.offsets.push_back(block.connectivity.size());
  block.face_locations.push_back(cells::CellBlock::no_faces);
  block.fields.pop_back();
  const cells::MeshFile file = cells::assemble_mesh({block}, {}, "mesh");
  double area = 0;
  for (std::size_t k = 0; k < 6; ++k) area += (p[k].x * p[(k + 1) % 6].y - p[(k + 1) % 6].x * p[k].y) / 2;
  EXPECT_NEAR(testing::volume(file.mesh), 2 * area, 1e-13);
  EXPECT_EQ(file.counts.cells_tangled, 0u);
  for (const auto& [place, uses] : testing::count_triangles(file.mesh))
    if (place[0][2] == 1 && place[1][2] == 1 && place[2][2] == 1) {
      EXPECT_EQ(uses, 2);
    }
}

TEST(ConvexPointSets, AreHullsThatFitTheirNeighbours) {
  for (const bool to_float : {false, true})
    for (unsigned seed = 1; seed < 9; ++seed) {
      SCOPED_TRACE(fmt::format("seed {}, float {}", seed, to_float));
      // Voronoi cells, some as polyhedra, others as their corners in any order.
      cells::CellBlock block = voronoi_mesh(40, seed);
      std::mt19937 random(seed);
      for (std::size_t c = 0; c < block.types.size(); ++c) {
        if (random() % 2 == 0) continue;
        block.types[c] = 41;
        block.face_locations[c] = cells::CellBlock::no_faces;
        std::shuffle(block.connectivity.begin() + static_cast<std::ptrdiff_t>(block.offsets[c]),
                     block.connectivity.begin() + static_cast<std::ptrdiff_t>(block.offsets[c + 1]), random);
      }
      for (glm::dvec3& p : block.positions)
        for (int a = 0; a < 3 && to_float; ++a) p[a] = static_cast<float>(p[a]);
      const cells::MeshFile file = cells::assemble_mesh({block}, {}, "mesh");
      EXPECT_EQ(file.counts.cells_polyhedra, 40u);
      std::size_t wrong = 0;
      for (const auto& [place, uses] : testing::count_triangles(file.mesh)) {
        bool on_wall = false;
        for (std::size_t a = 0; a < 3; ++a)
          for (const double at : {0.0, 1.0}) on_wall |= place[0][a] == at && place[1][a] == at && place[2][a] == at;
        wrong += uses != (on_wall ? 1 : 2);
      }
      EXPECT_EQ(wrong, 0u);
      EXPECT_NEAR(testing::volume(file.mesh), 1, to_float ? 1e-6 : 1e-12);
    }
}

TEST(ConvexPointSets, OfTooManyOrFlatPointsAreCounted) {
  cells::CellBlock block;
  std::mt19937 random(2);
  std::normal_distribution<double> anywhere;
  block.offsets = {0};
  for (const std::size_t n : {4, 300, 5}) {
    for (std::size_t k = 0; k < n; ++k) {
      const glm::dvec3 p(anywhere(random), anywhere(random), n == 5 ? 0 : anywhere(random));
      block.connectivity.push_back(static_cast<std::uint32_t>(block.positions.size()));
      block.positions.push_back(n == 5 ? p : glm::normalize(p));
    }
    block.types.push_back(41);
    block.offsets.push_back(block.connectivity.size());
  }
  const cells::MeshFile file = cells::assemble_mesh({block}, {}, "mesh");
  EXPECT_EQ(file.counts.cells_open, 1u);
  EXPECT_EQ(file.counts.cells_zero_volume, 1u);
  EXPECT_EQ(file.mesh.tets.size(), 1u);
}

}  // namespace
}  // namespace tessera::io
