// SPDX-License-Identifier: BSD-3-Clause
// Meshes with refinement levels: blocks of regular grids listed in a file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "cells/amr/amr_values.hpp"
#include "support/amr_files.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using namespace testing;

/// The interval of a line inside a tet; empty if the line misses the tet.
std::optional<std::pair<double, double>> stretch_in(const scene::TetMesh& mesh, const scene::Tet& tet,
                                                    const glm::dvec3& from, const glm::dvec3& along) {
  double low = -1e9, high = 1e9;
  for (std::size_t k = 0; k < 4; ++k) {
    const glm::dvec3 a = mesh.positions[tet[(k + 1) % 4]], b = mesh.positions[tet[(k + 2) % 4]],
                     c = mesh.positions[tet[(k + 3) % 4]];
    glm::dvec3 normal = glm::cross(b - a, c - a);
    if (glm::dot(normal, mesh.positions[tet[k]] - a) < 0) normal = -normal;
    const double height = glm::dot(normal, from - a), slope = glm::dot(normal, along);
    if (slope > 0)
      low = std::max(low, -height / slope);
    else if (slope < 0)
      high = std::min(high, -height / slope);
    else if (height < 0)
      return std::nullopt;
  }
  if (low >= high) return std::nullopt;
  return std::pair(low, high);
}

/// Lines through the block of nested_blocks(): some from random places, some exactly through corners of cells.
std::vector<std::pair<glm::dvec3, glm::dvec3>> lines() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> inside(0.01, 3.99), turn(-1, 1);
  std::vector<std::pair<glm::dvec3, glm::dvec3>> all;
  for (int n = 0; n < 400; ++n) {
    glm::dvec3 p(inside(random), inside(random), inside(random));
    if (n % 2 == 1) p = glm::round(4.0 * p) / 4.0;
    all.emplace_back(AmrScene::origin + AmrScene::unit * p,
                     glm::normalize(glm::dvec3(turn(random), turn(random), turn(random))));
  }
  return all;
}

TEST(Amr, LinesThroughCellDataSumUpWhatTheirFinestCellsHold) {
  const test::TemporaryFolder folder;
  const AmrScene amr = nested_blocks();
  const cells::MeshFile read = read_mesh(write_vth(folder, amr, false, wavy));
  scene::validate(read.mesh, "amr");
  EXPECT_EQ(read.mesh.association, scene::Association::cell);
  EXPECT_EQ(read.counts.cells_read, 64u - 8 - 1 + 64 - 8 + 2 * 64);
  EXPECT_NE(std::find(read.notes.begin(), read.notes.end(), "17 cells are covered by finer ones and left out"),
            read.notes.end());
  const double most = 4 * AmrScene::unit;
  for (const auto& [from, along] : lines()) {
    double sum = 0, length = 0;
    for (std::size_t t = 0; t < read.mesh.tets.size(); ++t)
      if (const auto stretch = stretch_in(read.mesh, read.mesh.tets[t], from, along)) {
        length += stretch->second - stretch->first;
        sum += (stretch->second - stretch->first) * read.mesh.scalars[t];
      }
    // The planes of the finest lattice cut the line into intervals. Their values are computed from the file alone.
    std::vector<double> cuts;
    double first = -1e9, last = 1e9;
    for (int a = 0; a < 3; ++a) {
      for (int plane = 0; plane <= 16; ++plane)
        cuts.push_back((AmrScene::origin + most * plane / 16 - from[a]) / along[a]);
      const auto [low, high] = std::minmax(cuts[cuts.size() - 17], cuts.back());
      first = std::max(first, low), last = std::min(last, high);
    }
    std::sort(cuts.begin(), cuts.end());
    double expected = 0;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
      const double begin = std::max(cuts[k], first), end = std::min(cuts[k + 1], last);
      if (end > begin) expected += (end - begin) * wavy(amr.centre_at(from + 0.5 * (begin + end) * along));
    }
    EXPECT_NEAR(length, last - first, 1e-9);
    EXPECT_NEAR(sum, expected, 1e-6);
  }
}

TEST(Amr, PointDataIsContinuousAcrossLevelsAndLinearWhereItIs) {
  const test::TemporaryFolder folder;
  for (const auto& at : {linear, wavy}) {
    const cells::MeshFile read = read_mesh(write_vth(folder, nested_blocks(), true, at));
    scene::validate(read.mesh, "amr");
    ASSERT_EQ(read.mesh.association, scene::Association::point);
    expect_conforming(read.mesh, glm::dvec3(4 * AmrScene::unit));
    for (std::size_t v = 0; at == linear && v < read.mesh.positions.size(); ++v)
      ASSERT_NEAR(read.mesh.scalars[v], linear(read.mesh.positions[v]), 1e-12);
  }
}

TEST(Amr, SmoothedCellDataIsContinuousAndLinearInsideAndKeepsEachCellsValue) {
  const test::TemporaryFolder folder;
  const AmrScene amr = nested_blocks();
  ReadOptions options;
  options.smooth = true;
  for (const auto& at : {linear, wavy}) {
    const cells::MeshFile read = read_mesh(write_vth(folder, amr, false, at), options);
    scene::validate(read.mesh, "amr");
    expect_smooth(read.mesh, amr, 4, at, at == linear, 1e-9);
    EXPECT_GE(read.mesh.positions.size(), 239u);
  }
}

TEST(Amr, BlocksThatCutThroughCoarserCellsLeaveTheRestOfThem) {
  const test::TemporaryFolder folder;
  const AmrScene amr{{{0, 1, {0, 0, 0}, {3, 3, 3}}, {1, 3, {1, 2, 3}, {7, 6, 5}}, {2, 6, {5, 6, 7}, {10, 9, 8}}}};
  for (const bool points : {false, true}) {
    const std::filesystem::path file = write_vth(folder, amr, points, linear);
    for (const bool smooth : {false, true}) {
      ReadOptions options;
      options.smooth = smooth;
      const cells::MeshFile read = read_mesh(file, options);
      EXPECT_NEAR(testing::volume(read.mesh), std::pow(4 * AmrScene::unit, 3), 1e-11) << points << smooth;
      if (points || smooth) expect_conforming(read.mesh, glm::dvec3(4 * AmrScene::unit));
      for (std::size_t v = 0; points && v < read.mesh.positions.size(); ++v)
        ASSERT_NEAR(read.mesh.scalars[v], linear(read.mesh.positions[v]), 1e-12);
      if (!points && !smooth) expect_cells(read.mesh, amr, 4, linear, 1e-12);
    }
  }
}

TEST(Amr, MaximumEntropyWeightsArePositiveWithTheRequestedMean) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> length(0.01, 4);
  for (int n = 0; n < 1000; ++n) {
    std::array<glm::dvec3, 8> offsets{};
    std::array<double, 8> weights{};
    weights.fill(1);
    for (int k = 0; k < 8; ++k) {  // one offset per octant, so that 0 is inside their hull
      const double size = length(random);
      offsets[static_cast<std::size_t>(k)] = size * glm::dvec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    }
    cells::weigh_by_entropy(offsets, weights);
    glm::dvec3 mean(0);
    double sum = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      EXPECT_GT(weights[k], 0);
      mean += weights[k] * offsets[k], sum += weights[k];
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_LT(glm::length(mean), 1e-9);
  }
}

TEST(Amr, ReportsTheBlockThatDoesNotNest) {
  const test::TemporaryFolder folder;
  const auto fault = [&](std::vector<Block> blocks) {
    return message_of([&] { read_mesh(write_vth(folder, {std::move(blocks)}, false, linear)); });
  };
  EXPECT_NE(fault({{0, 2, {0, 0, 0}, {3, 3, 3}}, {1, 3, {0, 0, 0}, {2, 2, 2}}}).find("whole ratios"),
            std::string::npos);
  EXPECT_NE(fault({{0, 1, {0, 0, 0}, {3, 3, 3}}, {1, 100, {0, 0, 0}, {2, 2, 2}}}).find("up to 64"), std::string::npos);
  const std::filesystem::path file = write_vth(folder, nested_blocks(), false, linear);
  folder.write("b1.vti", "<VTKFile");
  EXPECT_NE(message_of([&] { read_mesh(file); }).find("b1.vti: "), std::string::npos);
  EXPECT_NE(message_of([&] { read_mesh(folder.write("x.vth", "<a/>")); }).find("not a list of AMR blocks"),
            std::string::npos);
}

}  // namespace
}  // namespace tessera::io
