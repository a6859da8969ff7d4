// SPDX-License-Identifier: BSD-3-Clause
#include "cells/mesh_selection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "cells/mesh_assembly.hpp"
#include "datasets/boxes.hpp"
#include "datasets/conformity.hpp"
#include "datasets/modify.hpp"
#include "scene/error.hpp"

namespace tessera::io::mesh_selection_test {
namespace {

double linear(const glm::dvec3& p) { return 0.5 + p.x - 2 * p.y + 3 * p.z; }

scene::TetMesh cube_of_linear_field(int n, std::uint64_t seed = 7) {
  scene::TetMesh mesh = datasets::cube(n, 0.2, seed);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.scalars[v] = linear(mesh.positions[v]);
  return mesh;
}

scene::TetMesh selected(scene::TetMesh mesh, const Selection& selection, MeshCounts* counts = nullptr) {
  MeshCounts own;
  cells::select(mesh, selection, counts != nullptr ? *counts : own, "mesh");
  scene::validate(mesh, "mesh");
  return mesh;
}

double volume(const scene::TetMesh& mesh) {
  double sum = 0;
  for (const scene::Tet& tet : mesh.tets) sum += std::abs(datasets::signed_volume_6(mesh, tet)) / 6;
  return sum;
}

std::vector<HalfSpace> box(const glm::dvec3& low, const glm::dvec3& high) {
  const auto sides = half_spaces_of({low, high});
  return {sides.begin(), sides.end()};
}

/// Faces that belong to only one tet are on the cube's surface or a plane of the clip: a crack would have others.
void expect_no_cracks(const scene::TetMesh& mesh, std::span<const HalfSpace> clip, const std::string& words) {
  std::map<std::array<std::uint32_t, 3>, int> faces;
  for (const scene::Tet& tet : mesh.tets)
    for (std::size_t skip = 0; skip < 4; ++skip) {
      std::array<std::uint32_t, 3> face{};
      for (std::size_t i = 0, n = 0; i < 4; ++i)
        if (i != skip) face[n++] = tet[i];
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  for (const auto& entry : faces) {
    ASSERT_LE(entry.second, 2) << words;
    if (entry.second == 2) continue;
    const std::array<std::uint32_t, 3>& face = entry.first;
    const auto all_on = [&](const auto& distance) {
      return std::all_of(face.begin(), face.end(),
                         [&](std::uint32_t v) { return std::abs(distance(mesh.positions[v])) < 1e-12; });
    };
    bool on_surface = false;
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1, 1})
        on_surface = on_surface || all_on([&](const glm::dvec3& p) { return p[axis] - side; });
    for (const HalfSpace& h : clip)
      on_surface =
          on_surface || all_on([&](const glm::dvec3& p) { return glm::dot(p - h.point, glm::normalize(h.normal)); });
    ASSERT_TRUE(on_surface) << words;
  }
}

TEST(Clip, BothSidesOfAPlaneAreTheWhole) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int number = 0; number < 30; ++number) {
    const scene::TetMesh mesh = cube_of_linear_field(4, static_cast<std::uint64_t>(number));
    const HalfSpace side{{any(random), any(random), any(random)}, {any(random), any(random), any(random)}};
    const HalfSpace other{side.point, -3.0 * side.normal};
    const scene::TetMesh a = selected(mesh, {{side}}), b = selected(mesh, {{other}});
    EXPECT_NEAR(volume(a) + volume(b), 8, 1e-11) << number;
    for (const scene::TetMesh* part : {&a, &b}) {
      for (std::size_t v = 0; v < part->positions.size(); ++v) {
        EXPECT_NEAR(part->scalars[v], linear(part->positions[v]), 1e-13) << number;
        const double inside = glm::dot(part->positions[v] - side.point, side.normal) * (part == &a ? 1 : -1);
        EXPECT_GT(inside, -1e-14) << number;
      }
      expect_no_cracks(*part, std::array{side}, "case " + std::to_string(number));
    }
  }
}

TEST(Clip, SeveralPlanesLeaveNoCracks) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int number = 0; number < 30; ++number) {
    std::vector<HalfSpace> clip = box({-0.7, -0.61, -0.52}, {0.33, 0.45, 0.71});
    for (int plane = 0; plane < 3; ++plane)
      clip.push_back(
          {0.3 * glm::dvec3(any(random), any(random), any(random)), {any(random), any(random), any(random)}});
    expect_no_cracks(selected(cube_of_linear_field(4, static_cast<std::uint64_t>(number)), {clip}), clip,
                     "case " + std::to_string(number));
  }
}

/// Pieces of one mesh without shared vertices, as in ranks and files, are cut to the same faces.
TEST(Clip, PiecesAreCutAsTheWhole) {
  const scene::TetMesh whole = cube_of_linear_field(4);
  const std::vector<HalfSpace> clip{{{0.1, 0.05, 0}, {1, 2, -0.5}}, {{0, 0, 0.4}, {0.1, 0, -1}}};
  std::vector<scene::TetMesh> parts = datasets::parts(whole, 5, datasets::Partition::interleaved, 3);
  for (scene::TetMesh& part : parts) part = selected(std::move(part), {clip});
  const auto expected = datasets::count_faces(selected(whole, {clip})),
             found = datasets::count_faces(datasets::merged(parts));
  EXPECT_EQ(found.wrong, 0u);
  EXPECT_EQ(found.shared, expected.shared);
  EXPECT_EQ(found.boundary, expected.boundary);
  EXPECT_GT(found.shared, 100u);
}

TEST(Clip, ABoxInsideOneCellIsItsVolume) {
  scene::TetMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const glm::dvec3& p : mesh.positions) mesh.scalars.push_back(linear(p));
  mesh.tets = {{0, 1, 2, 3}};
  MeshCounts counts;
  const scene::TetMesh inside = selected(mesh, {box({0.1, 0.1, 0.1}, {0.2, 0.25, 0.3})}, &counts);
  EXPECT_NEAR(volume(inside), 0.1 * 0.15 * 0.2, 1e-16);
  for (std::size_t v = 0; v < inside.positions.size(); ++v)
    EXPECT_NEAR(inside.scalars[v], linear(inside.positions[v]), 1e-15);
  EXPECT_EQ(counts.cells_cut, 1u);
  EXPECT_EQ(counts.cells_clipped, 0u);
  EXPECT_EQ(counts.tets_made, inside.tets.size());
}

/// A plane along faces of cells divides no cell, even if the plane is oblique and its numbers are rounded.
TEST(Clip, PlanesThroughVerticesLeaveNoSplinters) {
  const scene::TetMesh straight = datasets::regular_split(6, 6, 6, glm::dvec3(0.1), glm::dvec3(0.3));
  for (const glm::dvec3 normal : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(1, -1, 0)}) {
    MeshCounts counts;
    const scene::TetMesh half = selected(straight, {{{straight.positions[3 + 7 * (3 + 7 * 3)], normal}}}, &counts);
    EXPECT_EQ(2 * half.tets.size(), straight.tets.size());
    EXPECT_EQ(counts.cells_cut, 0u);
  }
}

TEST(Clip, PlanesThatMissChangeNothing) {
  const scene::TetMesh mesh = datasets::cube(3);
  MeshCounts counts;
  const scene::TetMesh same = selected(mesh, {{{{-1, 0, 0}, {1, 0, 0}}, {{5, 5, 5}, {-1, -1, -1}}}}, &counts);
  EXPECT_EQ(same.positions, mesh.positions);
  EXPECT_EQ(same.tets, mesh.tets);
  EXPECT_EQ(counts.cells_clipped + counts.cells_cut, 0u);
}

TEST(Clip, RemovesAllBehindThePlane) {
  scene::TetMesh mesh = datasets::cube(3);
  MeshCounts counts;
  cells::select(mesh, {{{{1, 0, 0}, {1, 0, 0}}}}, counts, "a.vtu");  // only its surface remains
  EXPECT_TRUE(mesh.tets.empty());
  EXPECT_EQ(counts.cells_clipped, 162u);
  EXPECT_THROW(cells::require_selected(counts, "a.vtu"), scene::Error);
}

TEST(Clip, CellDataStaysTheCells) {
  const scene::TetMesh mesh = datasets::with_cell_data(datasets::cube(4), 6);
  const scene::TetMesh part = selected(mesh, {{{{0.1, 0, 0}, {1, 0.3, 0.2}}}});
  ASSERT_EQ(part.scalars.size(), part.tets.size());
  ASSERT_EQ(part.original_cell.size(), part.tets.size());
  for (std::size_t t = 0; t < part.tets.size(); ++t)
    EXPECT_EQ(part.scalars[t], mesh.scalars[6 * part.original_cell[t]]);
}

/// Two hexahedra, one with a corner out of range: all of its tets are removed, including those without that corner.
TEST(Threshold, KeepsWholeCellsOfPointData) {
  cells::CellBlock block;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 3; ++i) block.positions.emplace_back(i, j, k);
  block.types = {12, 12};
  block.offsets = {0, 8, 16};
  block.connectivity = {0, 1, 4, 3, 6, 7, 10, 9, 1, 2, 5, 4, 7, 8, 11, 10};
  std::vector<double> values(12, 1.0);
  values[0] = 3;
  block.fields.push_back(cells::field_of_values("f", "double", scene::Association::point, 1, values));
  const cells::MeshFile file = cells::assemble_mesh({block}, {}, "mesh");
  MeshCounts counts = file.counts;
  EXPECT_NEAR(volume(selected(file.mesh, {{}, {{0.0, 2.0}}}, &counts)), 1, 1e-15);
  EXPECT_EQ(counts.cells_out_of_range, 1u);
  EXPECT_NEAR(volume(selected(file.mesh, {{}, {{1.0, 3.0}}})), 2, 1e-15);  // both ends are included
  counts = file.counts;
  selected(file.mesh, {{}, {{4.0, 5.0}}}, &counts);
  EXPECT_THROW(cells::require_selected(counts, "mesh"), scene::Error);
}

TEST(Threshold, GoesByTheCellsValue) {
  const scene::TetMesh mesh = datasets::with_cell_data(datasets::cube(3), 1);
  const auto range = scene::scalar_range(mesh);
  const double middle = (range[0] + range[1]) / 2;
  MeshCounts low, high;
  const std::size_t below = selected(mesh, {{}, {{range[0], middle}}}, &low).tets.size(),
                    above = selected(mesh, {{}, {{middle, range[1]}}}, &high).tets.size();
  EXPECT_EQ(below + above, mesh.tets.size());
  EXPECT_EQ(low.cells_out_of_range, above);
  EXPECT_EQ(high.cells_out_of_range, below);
}

TEST(Selection, RefusesEmptySelections) {
  EXPECT_THROW(validate(Selection{{{{0, 0, 0}, {0, 0, 0}}}}), scene::Error);
  EXPECT_THROW(validate(Selection{{{{0, 0, NAN}, {0, 0, 1}}}}), scene::Error);
  EXPECT_THROW(validate(Selection{{}, {{2, 1}}}), scene::Error);
  EXPECT_THROW(validate(Selection{{}, {{NAN, 1}}}), scene::Error);
}

}  // namespace
}  // namespace tessera::io::mesh_selection_test
