// SPDX-License-Identifier: BSD-3-Clause
// HyperTreeGrids: trees of cells on a rectilinear grid.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "readers/hyper_tree_files.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using namespace testing;

const std::array<std::vector<double>, 3> even{{{0.3, 1, 1.7, 2.4}, {-1, -0.5, 0}, {2, 2.5, 3, 3.5}}},
    uneven{{{0.3, 1, 1.2, 2.4}, {-1, -0.8, 0}, {2, 2.5, 3.7, 4}}};

/// Deep around one place, so that cells of level 0 touch some of level 3, and random elsewhere.
TreeScene deep(const std::array<std::vector<double>, 3>& axes, int branching) {
  TreeScene scene;
  scene.axes = axes;
  scene.branching = branching;
  const glm::dvec3 about(axes[0][1] - 0.01, axes[1][1] - 0.01, axes[2][1] - 0.01);
  scene.is_divided = [about, branching](const TreeCell& cell) {
    return cell.level < (branching == 2 ? 3 : 2) && cell.holds(about);
  };
  return scene;
}

bool is_masked(const TreeCell& cell) {
  return cell.level == 1 && cell.centre().x > 0.6 && cell.centre().x < 1.2 && cell.centre().z < 2.4;
}

TEST(HyperTrees, CellsAreThoseOfTheLeavesWithTheirValues) {
  const test::TemporaryFolder folder;
  for (const int version : {0, 1, 2})
    for (const int branching : {2, 3})
      for (const bool transposed : {false, true})
        for (const char* field : {"f", "v:y"}) {
          TreeScene scene = deep(uneven, branching);
          scene.is_masked = is_masked;
          const auto file =
              folder.write("t.htg", htg_text(scene, wavy, {.version = version, .transposed = transposed}));
          ReadOptions options;
          options.field = field;
          const cells::MeshFile read = read_mesh(file, options);
          scene::validate(read.mesh, "trees");
          const std::vector<TreeCell> leaves = scene.leaves();
          EXPECT_EQ(read.counts.cells_read, leaves.size());
          ASSERT_EQ(read.mesh.association, scene::Association::cell);
          double whole = 0;
          for (const TreeCell& leaf : leaves) {
            const glm::dvec3 size = leaf.high - leaf.low;
            whole += size.x * size.y * size.z;
          }
          EXPECT_LT(whole, 0.999 * scene.sides().x * scene.sides().y * scene.sides().z) << "nothing is masked";
          EXPECT_NEAR(volume(read.mesh), whole, 1e-12 * whole);
          for (std::size_t t = 0; t < read.mesh.tets.size(); ++t) {
            glm::dvec3 centre(0);
            for (const std::uint32_t v : read.mesh.tets[t]) centre += 0.25 * read.mesh.positions[v];
            const auto leaf =
                std::find_if(leaves.begin(), leaves.end(), [&](const TreeCell& cell) { return cell.holds(centre); });
            ASSERT_NE(leaf, leaves.end());
            ASSERT_NEAR(read.mesh.scalars[t], wavy(leaf->centre()), 1e-12);
          }
        }
}

TEST(HyperTrees, SmoothedTheyAreContinuousAcrossLevelsAndLinearInside) {
  const test::TemporaryFolder folder;
  ReadOptions options;
  options.smooth = true;
  options.field = std::string("f");
  for (const auto& axes : {even, uneven})
    for (const int branching : {2, 3})
      for (const auto& at : {linear, wavy}) {
        const TreeScene scene = deep(axes, branching);
        const cells::MeshFile read = read_mesh(folder.write("t.htg", htg_text(scene, at)), options);
        scene::validate(read.mesh, "trees");
        ASSERT_EQ(read.mesh.association, scene::Association::point);
        expect_conforming(read.mesh, scene.sides());
        const std::vector<TreeCell> leaves = scene.leaves();
        EXPECT_GT(leaves.back().level + 1, 0);
        std::size_t inner = 0;
        for (std::size_t v = 0; v < read.mesh.positions.size(); ++v) {
          const glm::dvec3 p = read.mesh.positions[v];
          // Between the outermost roots' centres: the limit of continuing any leaf's value outwards.
          bool is_inside = true;
          for (int a = 0; a < 3; ++a) {
            const std::vector<double>& axis = axes[static_cast<std::size_t>(a)];
            const std::size_t n = axis.size();
            is_inside = is_inside && p[a] >= 0.5 * (axis[0] + axis[1]) - 1e-9 &&
                        p[a] <= 0.5 * (axis[n - 2] + axis[n - 1]) + 1e-9;
          }
          if (!is_inside || at != linear) continue;
          ++inner;
          EXPECT_NEAR(read.mesh.scalars[v], linear(p), 1e-9);
        }
        EXPECT_TRUE(at != linear || inner > 50u) << inner;
        for (const TreeCell& leaf : leaves) {
          const auto centre = std::find_if(read.mesh.positions.begin(), read.mesh.positions.end(),
                                           [&](const glm::dvec3& p) { return glm::length(p - leaf.centre()) < 1e-9; });
          ASSERT_NE(centre, read.mesh.positions.end());
          ASSERT_NEAR(read.mesh.scalars[static_cast<std::size_t>(centre - read.mesh.positions.begin())],
                      at(leaf.centre()), 1e-12);
        }
      }
}

TEST(HyperTrees, PiecesAreOneGridAndGhostsAreLeftOut) {
  const test::TemporaryFolder folder;
  const TreeScene scene = deep(uneven, 2);
  const auto is_deep = [](const std::array<std::size_t, 3>& root) { return root[0] == 0; };
  TreeWish first, second;
  first.has_root = is_deep;
  second.has_root = [&](const auto& root) { return !is_deep(root); };
  folder.write("p0.htg", htg_text(scene, wavy, first));
  folder.write("p1.htg", htg_text(scene, wavy, second));
  const std::string list =
      "<VTKFile type=\"PHyperTreeGrid\" version=\"2.0\"><PHyperTreeGrid><Piece Source=\"p0.htg\"/>"
      "<Piece Source=\"p1.htg\"/></PHyperTreeGrid></VTKFile>";
  const auto pieces = folder.write("p.phtg", list), whole = folder.write("whole.htg", htg_text(scene, wavy));
  for (const bool smooth : {false, true}) {
    ReadOptions options;
    options.smooth = smooth;
    options.field = std::string("f");
    const cells::MeshFile a = read_mesh(pieces, options), b = read_mesh(whole, options);
    EXPECT_EQ(a.counts.cells_read, b.counts.cells_read);
    EXPECT_NEAR(volume(a.mesh), volume(b.mesh), 1e-12 * volume(b.mesh));
    std::vector<double> x(a.mesh.scalars.begin(), a.mesh.scalars.end()),
        y(b.mesh.scalars.begin(), b.mesh.scalars.end());
    std::sort(x.begin(), x.end()), std::sort(y.begin(), y.end());
    EXPECT_EQ(x, y);
  }
  // Trees in both files are ghosts in one of them, or an error.
  second.has_root = [](const auto&) { return true; };
  folder.write("p1.htg", htg_text(scene, wavy, second));
  const std::string twice = message_of([&] { read_mesh(pieces); });
  EXPECT_NE(twice.find("write each tree once"), std::string::npos) << twice;
  first.ghost = [](const TreeCell&) { return 0; };
  second.ghost = [&](const TreeCell& cell) { return cell.centre().x < scene.axes[0][1] ? 1 : 0; };
  folder.write("p0.htg", htg_text(scene, wavy, first));
  folder.write("p1.htg", htg_text(scene, wavy, second));
  EXPECT_EQ(read_mesh(pieces).counts.cells_read, scene.leaves().size());
  TreeScene other = scene;
  other.axes[1][1] = -0.7;
  folder.write("p1.htg", htg_text(other, wavy, second));
  EXPECT_NE(message_of([&] { read_mesh(pieces); }).find("its coordinates along y differ from those of piece 'p0.htg'"),
            std::string::npos);
}

TEST(HyperTrees, ReportsUnsupportedContentInOneLine) {
  const test::TemporaryFolder folder;
  const TreeScene scene = deep(even, 2);
  const std::string good = htg_text(scene, linear);
  const auto fault = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
    const auto file = folder.write("t.htg", text);
    const std::string message = message_of([&] { read_mesh(file); });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_TRUE(message.starts_with(file.string() + ": ")) << message;
    return message;
  };
  const auto has = [](const std::string& message, const char* words) {
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  TreeScene flat = scene;
  flat.axes[2] = {2};
  const auto plane = folder.write("plane.htg", htg_text(flat, linear));
  has(message_of([&] { read_mesh(plane); }), "its trees have 2 dimensions; give a three-dimensional grid");
  has(fault("BranchFactor=\"2\"", "BranchFactor=\"4\""), "divided by 4");
  has(fault("Dimensions=\"4 3 4\"", "Dimensions=\"4 3 5\""), "4 coordinates along z for 5 points");
  has(fault("0.3 1 1.7 2.4", "0.3 1 1 2.4"), "increasing coordinates");
  has(fault("0.3 1 1.7 2.4", "0.3 1 1.7 nan"), "XCoordinates");
  has(fault("0.3 1 1.7 2.4", "0.3 1"), "array 'XCoordinates' ends before its 4 numbers do");
  has(fault("Name=\"ZCoordinates\"", "Name=\"Z\""), "it has no array ZCoordinates");
  has(fault("Name=\"TreeIds\" NumberOfComponents=\"1\" NumberOfTuples=\"18\" format=\"ascii\">0 1 2",
            "Name=\"TreeIds\" NumberOfComponents=\"1\" NumberOfTuples=\"18\" format=\"ascii\">0 1 18"),
      "tree 2 belongs to cell 18, but the grid has 3 x 2 x 3 cells");
  has(fault("Name=\"TreeIds\" NumberOfComponents=\"1\" NumberOfTuples=\"18\" format=\"ascii\">0 1 2",
            "Name=\"TreeIds\" NumberOfComponents=\"1\" NumberOfTuples=\"18\" format=\"ascii\">0 1 1"),
      "its trees do not match its grid");
  has(fault("Name=\"Descriptors\" NumberOfComponents=\"1\" NumberOfTuples=\"17\" format=\"ascii\">1 0",
            "Name=\"Descriptors\" NumberOfComponents=\"1\" NumberOfTuples=\"17\" format=\"ascii\">1 1"),
      "according to its counts");
  has(fault("NumberOfTuples=\"17\"", "NumberOfTuples=\"99999999999\""), "more than a file of this size can contain");
  has(fault("NumberOfTuples=\"17\"", "NumberOfTuples=\"-17\""), "array 'Descriptors' has -17 numbers");
  has(fault("</VTKFile>", ""), "it does not end with </VTKFile>");
  has(fault("<Trees>", "<Tress>"), "mismatched tag");
}

TEST(HyperTrees, ChangedBytesAreReadOrRefused) {
  const test::TemporaryFolder folder;
  for (const int version : {0, 1, 2}) {
    const auto file = folder.write("t.htg", htg_text(deep(uneven, 2), wavy, {.version = version}));
    expect_read_or_refused(file, file, 24);
  }
}

TEST(HyperTrees, LevelsTooDeepForTheLatticeAreRefused) {
  const test::TemporaryFolder folder;
  TreeScene scene = deep(even, 2);
  scene.is_divided = [](const TreeCell& cell) { return cell.level < 30 && cell.holds({0.31, -0.99, 2.01}); };
  const auto file = folder.write("t.htg", htg_text(scene, linear));
  EXPECT_NE(message_of([&] { read_mesh(file); }).find("write it with fewer levels"), std::string::npos);
}

}  // namespace
}  // namespace tessera::io
