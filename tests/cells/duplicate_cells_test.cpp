// SPDX-License-Identifier: BSD-3-Clause
// Cells that occur twice in a mesh: counted, and on request drawn once.
#include "cells/duplicate_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "cells/mesh_assembly.hpp"
#include "io/mesh/mesh_parts.hpp"
#include "scene/threads.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io::duplicate_cells_test {
namespace {

using scene::Association;

/// The mesh of mixed cells, of volume 1.
scene::TetMesh mixed_tets(bool own_points) {
  std::vector<cells::CellBlock> blocks;
  blocks.push_back(testing::mixed_mesh(6, 7, own_points));
  return cells::assemble_mesh(std::move(blocks), {}, "mesh").mesh;
}

/// The mesh followed by copies of the cells selected by `again`. The copies have separate points, and the corners of
/// each tet and the tets of each cell are in another order.
scene::TetMesh with_copies(scene::TetMesh mesh, const auto& again, unsigned seed) {
  std::mt19937 random(seed);
  const std::size_t tets = mesh.tets.size();
  const std::uint64_t cells = mesh.cell_of(tets - 1) + 1;
  if (mesh.original_cell.empty()) {
    mesh.original_cell.resize(tets);
    std::iota(mesh.original_cell.begin(), mesh.original_cell.end(), std::uint64_t{0});
  }
  for (std::size_t first = 0, last = 0; first < tets; first = last) {
    for (last = first; last < tets && mesh.original_cell[last] == mesh.original_cell[first]; ++last) {
    }
    if (!again(mesh.original_cell[first])) continue;
    std::vector<std::size_t> order(last - first);
    std::iota(order.begin(), order.end(), first);
    std::shuffle(order.begin(), order.end(), random);
    for (const std::size_t t : order) {
      scene::Tet tet = mesh.tets[t];
      std::shuffle(tet.begin(), tet.end(), random);
      for (std::uint32_t& v : tet) {
        const glm::dvec3 p = mesh.positions[v];
        const double value = mesh.scalars[v];
        v = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(p), mesh.scalars.push_back(value);
      }
      mesh.tets.push_back(tet);
      mesh.original_cell.push_back(cells + mesh.original_cell[first]);
    }
  }
  return mesh;
}

TEST(DuplicateCells, AMeshWithoutDuplicatesHasNone) {
  for (const bool own_points : {false, true}) {
    scene::TetMesh mesh = mixed_tets(own_points);
    const std::size_t tets = mesh.tets.size();
    EXPECT_EQ(cells::find_duplicate_cells(mesh, true), 0u);
    EXPECT_EQ(mesh.tets.size(), tets);
  }
}

TEST(DuplicateCells, AreFoundByTheirCornersAndDropped) {
  const scene::TetMesh once = mixed_tets(false);
  const auto some = [](std::uint64_t cell) { return cell % 3 == 1; };
  std::vector<std::uint64_t> cells = once.original_cell;
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  const auto expected = static_cast<std::uint64_t>(std::ranges::count_if(cells, some));
  ASSERT_GT(expected, 20u);
  for (const int threads : {1, 4}) {
    scene::TetMesh mesh = with_copies(once, some, 3);
    const std::size_t tets = mesh.tets.size();
    EXPECT_GT(tets, once.tets.size());
    EXPECT_EQ(scene::with_threads(threads, [&] { return cells::find_duplicate_cells(mesh, false); }), expected);
    EXPECT_EQ(mesh.tets.size(), tets);
    EXPECT_EQ(scene::with_threads(threads, [&] { return cells::find_duplicate_cells(mesh, true); }), expected);
    EXPECT_EQ(mesh.tets, once.tets) << "the first of equal cells stay";
    EXPECT_EQ(mesh.original_cell, once.original_cell);
    EXPECT_EQ(scene::with_threads(threads, [&] { return cells::find_duplicate_cells(mesh, true); }), 0u);
  }
}

TEST(DuplicateCells, ATetInsideAnotherCellIsNotADuplicate) {
  const scene::TetMesh once = mixed_tets(false);
  scene::TetMesh mesh = once;
  std::size_t split = 0;  // a tet of a cell that has several tets
  while (mesh.cell_of(split) != mesh.cell_of(split + 1)) ++split;
  mesh.tets.push_back(mesh.tets[split]);
  mesh.original_cell.push_back(mesh.original_cell.back() + 1);
  EXPECT_EQ(cells::find_duplicate_cells(mesh, true), 0u);
}

TEST(DuplicateCells, ManyCopiesOfOneLeaveOne) {
  scene::TetMesh mesh;
  mesh.association = Association::cell;
  for (std::uint32_t k = 0; k < 100000; ++k) {
    mesh.tets.push_back({0, 1, 2, 3});
    mesh.scalars.push_back(k);
  }
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_EQ(cells::find_duplicate_cells(mesh, true), 99999u);
  ASSERT_EQ(mesh.tets.size(), 1u);
  EXPECT_EQ(mesh.scalars, std::vector<double>{0});
  EXPECT_EQ(mesh.original_cell, std::vector<std::uint64_t>{0});
}

class DuplicateFiles : public ::testing::Test {
 protected:
  /// A .pvtu of two pieces.
  std::filesystem::path pieces(const cells::CellBlock& first, const cells::CellBlock& second) const {
    folder.write("a.vtu", testing::vtu_text(first));
    folder.write("b.vtu", testing::vtu_text(second));
    return folder.write("m.pvtu", testing::pvtu_text(second, {"a.vtu", "b.vtu"}));
  }
  test::TemporaryFolder folder;
};

TEST_F(DuplicateFiles, ARepeatedPieceIsAWarningAndDrawnOnceIfAskedFor) {
  const cells::CellBlock block = testing::mixed_mesh(3, 5, false);
  const auto file = pieces(block, block);
  const std::uint64_t cells = block.types.size();
  const cells::MeshFile twice = read_mesh(file);
  EXPECT_EQ(twice.counts.cells_duplicate, cells);
  EXPECT_NEAR(testing::volume(twice.mesh), 2, 1e-9);
  const std::vector<std::string> warnings = cells::warnings_on_cells(twice.counts, twice.higher_order);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find(std::to_string(cells) + " cells have the corners of other cells"), std::string::npos)
      << warnings[0];
  EXPECT_NE(warnings[0].find("`drop_duplicates`"), std::string::npos);
  ReadOptions options;
  options.drop_duplicates = true;
  const cells::MeshFile once = read_mesh(file, options);
  EXPECT_EQ(once.counts.cells_duplicate, 0u);
  EXPECT_EQ(once.counts.duplicates_dropped, cells);
  EXPECT_EQ(once.counts.tets_made, once.mesh.tets.size());
  EXPECT_NEAR(testing::volume(once.mesh), 1, 1e-9);
  EXPECT_TRUE(cells::warnings_on_cells(once.counts, once.higher_order).empty());
  EXPECT_TRUE(readable_in_parts(io::identify(file), {}));
  EXPECT_FALSE(readable_in_parts(io::identify(file), options)) << "two parts would each keep their copy";
  // The same holds for several files of one mesh, such as those that a .pvd lists for one time.
  const std::vector<std::filesystem::path> files = {folder / "a.vtu", folder / "b.vtu"};
  EXPECT_EQ(read_mesh(files).counts.cells_duplicate, cells);
  EXPECT_NEAR(testing::volume(read_mesh(files, options).mesh), 1, 1e-9);
}

TEST_F(DuplicateFiles, GhostCellsAreNotDuplicates) {
  const cells::CellBlock block = testing::mixed_mesh(3, 5, false);
  cells::CellBlock ghosts = testing::mixed_mesh(3, 5, false), own = testing::mixed_mesh(3, 5, false);
  ghosts.cell_ghost.assign(ghosts.types.size(), 1);
  own.cell_ghost.assign(own.types.size(), 0);
  const cells::MeshFile mesh = read_mesh(pieces(own, ghosts));
  EXPECT_EQ(mesh.counts.cells_ghost, block.types.size());
  EXPECT_EQ(mesh.counts.cells_duplicate, 0u);
  EXPECT_NEAR(testing::volume(mesh.mesh), 1, 1e-9);
  // Older files use vtkGhostLevels instead of vtkGhostType.
  for (const char* name : {"a.vtu", "b.vtu", "m.pvtu"}) {
    std::string text = test::contents(folder / name);
    for (std::size_t at = text.find("vtkGhostType"); at != std::string::npos; at = text.find("vtkGhostType", at + 1))
      text.replace(at, 12, "vtkGhostLevels");
    folder.write(name, text);
  }
  const cells::MeshFile levels = read_mesh(folder / "m.pvtu");
  EXPECT_EQ(levels.counts.cells_ghost, block.types.size());
  EXPECT_NEAR(testing::volume(levels.mesh), 1, 1e-9);
}

TEST_F(DuplicateFiles, EveryDuplicateOfALargeMeshIsCounted) {
  const auto assembled = [](const ReadOptions& options, bool repeated) {
    std::vector<cells::CellBlock> blocks;
    blocks.push_back(testing::mixed_mesh(24, 5, false));
    blocks.push_back(testing::mixed_mesh(24, 5, false));
    cells::CellBlock& copy = blocks.back();  // with few cells
    copy.types.resize(repeated ? 3 : 0);
    copy.offsets.resize(copy.types.size() + 1);
    copy.connectivity.resize(copy.offsets.back());
    return cells::assemble_mesh(std::move(blocks), options, "mesh");
  };
  const cells::MeshFile once = assembled({}, false);
  ASSERT_GT(once.mesh.tets.size(), 65536u);
  EXPECT_EQ(once.counts.cells_duplicate, 0u);
  ReadOptions options;
  EXPECT_EQ(assembled(options, true).counts.cells_duplicate, 3u);
  options.drop_duplicates = true;
  const cells::MeshFile dropped = assembled(options, true);
  EXPECT_EQ(dropped.counts.duplicates_dropped, 3u);
  EXPECT_EQ(dropped.mesh.tets, once.mesh.tets);
}

TEST_F(DuplicateFiles, KeysOfPartsGiveTheCountOfTheWhole) {
  const scene::TetMesh once = mixed_tets(false);
  const scene::TetMesh twice = with_copies(
      once, [](std::uint64_t cell) { return cell % 5 == 2; }, 9);
  scene::TetMesh copies = twice;  // the added cells as a separate part
  const auto first = static_cast<std::ptrdiff_t>(once.tets.size());
  copies.tets.erase(copies.tets.begin(), copies.tets.begin() + first);
  copies.original_cell.erase(copies.original_cell.begin(), copies.original_cell.begin() + first);
  std::vector<std::uint64_t> keys = cells::duplicate_keys(once);
  EXPECT_EQ(cells::count_repetitions(keys), 0u);
  const std::vector<std::uint64_t> others = cells::duplicate_keys(copies);
  scene::TetMesh counted = twice;
  const std::uint64_t expected = cells::find_duplicate_cells(counted, false);
  EXPECT_EQ(others.size(), expected);
  keys.insert(keys.end(), others.begin(), others.end());
  EXPECT_EQ(cells::count_repetitions(keys), expected);
  keys.insert(keys.end(), others.begin(), others.end());
  EXPECT_EQ(cells::count_repetitions(keys), 2 * expected);
}

TEST_F(DuplicateFiles, ABlankCopyIsNeitherDrawnNorADuplicate) {
  std::vector<cells::CellBlock> blocks;
  blocks.push_back(testing::mixed_mesh(3, 5, false));
  blocks.push_back(testing::mixed_mesh(3, 5, false));
  blocks[0].name = "with", blocks[1].name = "without";
  blocks[1].fields.clear();
  ReadOptions options;
  options.drop_duplicates = true;
  const cells::MeshFile mesh = cells::assemble_mesh(std::move(blocks), options, "mesh");
  EXPECT_EQ(mesh.counts.duplicates_dropped, 0u);
  EXPECT_EQ(mesh.counts.cells_nan, mesh.counts.cells_read / 2);
  EXPECT_NEAR(testing::volume(mesh.mesh), 1, 1e-9);
}

}  // namespace
}  // namespace tessera::io::duplicate_cells_test
