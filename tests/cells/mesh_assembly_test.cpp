// SPDX-License-Identifier: BSD-3-Clause
#include "cells/mesh_assembly.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "scene/threads.hpp"
#include "support/mesh_checks.hpp"

namespace tessera::io {
namespace {

using scene::Association;
using testing::message_of;
constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

/// A row of n tets without shared points; cell c has the points 4 c to 4 c + 3, and the value c at its points and its
/// cell.
cells::CellBlock row_of_tets(std::size_t n) {
  cells::CellBlock block;
  std::vector<double> point, cell;
  for (std::size_t c = 0; c < n; ++c) {
    const glm::dvec3 o(2.0 * static_cast<double>(c), 0, 0);
    const auto first = static_cast<std::uint32_t>(4 * c);
    block.tets.push_back({first, first + 1, first + 2, first + 3});
    for (const glm::dvec3& p : {o, o + glm::dvec3(1, 0, 0), o + glm::dvec3(0, 1, 0), o + glm::dvec3(0, 0, 1)}) {
      block.positions.push_back(p);
      point.push_back(static_cast<double>(c));
    }
    cell.push_back(static_cast<double>(c));
  }
  block.fields.push_back(cells::field_of_values("p", "double", Association::point, 1, std::move(point)));
  block.fields.push_back(cells::field_of_values("c", "double", Association::cell, 1, std::move(cell)));
  return block;
}

cells::MeshFile assemble(const cells::CellBlock& block, const std::string& field = "p") {
  ReadOptions options;
  options.field = field;
  cells::MeshFile file = cells::assemble_mesh({block}, options, "mesh");
  scene::validate(file.mesh, "mesh");
  return file;
}

/// The tets as cells of type 10 with offsets, so that others can be added.
cells::CellBlock with_types(cells::CellBlock block) {
  block.types.assign(block.tets.size(), 10);
  for (const scene::Tet& tet : block.tets) block.connectivity.insert(block.connectivity.end(), tet.begin(), tet.end());
  block.tets.clear();
  for (std::size_t c = 0; c <= block.types.size(); ++c) block.offsets.push_back(4 * c);
  return block;
}

TEST(MeshAssembly, TetsThatAllStayNeedNoCellNumbers) {
  const cells::MeshFile file = assemble(row_of_tets(3));
  EXPECT_EQ(file.mesh.tets.size(), 3u);
  EXPECT_TRUE(file.mesh.original_cell.empty());
  EXPECT_EQ(file.counts.tets_made, 3u);
  EXPECT_EQ(file.counts.points_unused, 0u);
}

TEST(MeshAssembly, GhostAndHiddenCellsAreDroppedAndCounted) {
  cells::CellBlock block = row_of_tets(6);
  block.cell_ghost = {0, 1, 32, 33, 8, 0};
  for (const char* field : {"p", "c"}) {
    const cells::MeshFile file = assemble(block, field);
    EXPECT_EQ(file.counts.cells_ghost, 2u);
    EXPECT_EQ(file.counts.cells_hidden, 2u);
    EXPECT_EQ(file.mesh.original_cell, (std::vector<std::uint64_t>{0, 5}));
    EXPECT_EQ(file.counts.points_unused, 16u);
    EXPECT_EQ(scene::scalar_range(file.mesh), (std::array<double, 2>{0, 5}));
  }
}

TEST(MeshAssembly, AHiddenPointHidesItsCellsAndADuplicateOneDoesNot) {
  cells::CellBlock block = row_of_tets(3);
  block.point_ghost.assign(12, 0);
  block.point_ghost[5] = 2;
  block.point_ghost[9] = 1;
  const cells::MeshFile file = assemble(block);
  EXPECT_EQ(file.counts.cells_hidden, 1u);
  EXPECT_EQ(file.mesh.original_cell, (std::vector<std::uint64_t>{0, 2}));
}

TEST(MeshAssembly, NaNAndInfiniteNumbersBlankTheirCells) {
  cells::CellBlock block = row_of_tets(5);
  std::vector<double> p(20, 1.0), c(5, 1.0);
  p[2] = nan;
  p[6] = -inf;
  c[4] = inf;
  block.positions[14].y = nan;
  block.fields = {cells::field_of_values("p", "double", Association::point, 1, p),
                  cells::field_of_values("c", "double", Association::cell, 1, c)};
  EXPECT_EQ(assemble(block).counts.cells_nan, 3u);
  EXPECT_EQ(assemble(block).mesh.tets.size(), 2u);
  EXPECT_EQ(assemble(block, "c").counts.cells_nan, 2u);
}

TEST(MeshAssembly, AMeshOfNaNIsAnErrorWithItsCounts) {
  cells::CellBlock block = row_of_tets(2);
  block.fields = {cells::field_of_values("p", "double", Association::point, 1, std::vector<double>(8, nan))};
  const std::string message = message_of([&] { assemble(block); });
  EXPECT_NE(message.find("mesh: nothing is left to render: of 2 cells"), std::string::npos) << message;
  EXPECT_NE(message.find("2 hold NaN"), std::string::npos) << message;
  EXPECT_NE(message_of([] { cells::assemble_mesh({}, {}, "mesh"); }).find("has no cells"), std::string::npos);
}

TEST(MeshAssembly, FlatCellsAreKeptAndCounted) {
  cells::CellBlock block = row_of_tets(3);
  block.positions[7] = {3.25, 0.25, 0};  // in the plane of the other three
  const cells::MeshFile file = assemble(block);
  EXPECT_EQ(file.counts.cells_zero_volume, 1u);
  EXPECT_EQ(file.mesh.tets.size(), 3u);
}

TEST(MeshAssembly, TetsWithCoincidentCornersAreNotMade) {
  cells::CellBlock block = row_of_tets(3);
  block.tets[1][1] = block.tets[1][0];            // a repeated index
  block.positions[8] = block.positions[9] + 0.0;  // another point at the same position
  const cells::MeshFile file = assemble(block);
  EXPECT_EQ(file.counts.tets_collapsed, 2u);
  EXPECT_EQ(file.counts.cells_zero_volume, 2u);
  EXPECT_EQ(file.mesh.tets.size(), 1u);
}

TEST(MeshAssembly, EitherHandednessIsKept) {
  cells::CellBlock block = row_of_tets(2);
  std::swap(block.tets[0][0], block.tets[0][1]);
  const cells::MeshFile file = assemble(block);
  EXPECT_EQ(file.mesh.tets.size(), 2u);
  EXPECT_EQ(file.counts.cells_zero_volume + file.counts.cells_tangled, 0u);
}

TEST(MeshAssembly, FacesAndLinesAreSkippedAndCounted) {
  cells::CellBlock block = with_types(row_of_tets(1));
  block.types.insert(block.types.end(), {5, 3, 1});
  block.connectivity.insert(block.connectivity.end(), {0, 1, 2, 0, 1, 0});
  block.offsets.insert(block.offsets.end(), {7, 9, 10});
  block.fields.pop_back();
  const cells::MeshFile file = assemble(block);
  EXPECT_EQ(file.counts.cells_read, 4u);
  EXPECT_EQ(file.counts.cells_not_volumetric, 3u);
  EXPECT_EQ(file.mesh.tets.size(), 1u);
}

TEST(MeshAssembly, HigherOrderCellsUseTheirCornersIfNoneMayBeDivided) {
  cells::CellBlock block = row_of_tets(3);  // twelve points: enough for a ten-node tet
  block.tets.clear();
  block.types = {24};
  block.connectivity = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  block.offsets = {0, 10};
  block.fields.pop_back();
  ReadOptions options;
  options.higher_order_tets = 0;
  const cells::MeshFile file = cells::assemble_mesh({block}, options, "mesh");
  EXPECT_EQ(file.mesh.tets.front(), (scene::Tet{0, 1, 2, 3}));
  EXPECT_EQ(file.counts.cells_quadratic, 1u);
  EXPECT_EQ(file.higher_order.by_corners, 1u);
  const std::vector<std::string> warnings = cells::warnings_on_cells(file.counts, file.higher_order);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("1 higher-order cells are rendered as linear cells with the same corners"),
            std::string::npos);
  EXPECT_TRUE(cells::warnings_on_cells({}, {}).empty());
}

TEST(MeshAssembly, PolyhedraAndWrongNodeCountsAreRefusedByCell) {
  cells::CellBlock block = with_types(row_of_tets(3));
  block.types[2] = 42;
  EXPECT_NE(message_of([&] { assemble(block); }).find("cell 2 is a polyhedron"), std::string::npos);
  block.types[2] = 12;
  EXPECT_NE(message_of([&] { assemble(block); }).find("cell 2 is a hexahedron with 4 nodes, but must have 8"),
            std::string::npos);
}

TEST(MeshAssembly, BlocksFollowEachOtherAndALackingFieldBlanksItsBlock) {
  cells::CellBlock second = row_of_tets(2), third = row_of_tets(2);
  second.name = "shell";
  second.fields.clear();
  ReadOptions options;
  options.field = "p";
  const cells::MeshFile file = cells::assemble_mesh({row_of_tets(2), second, third}, options, "mesh");
  scene::validate(file.mesh, "mesh");
  EXPECT_EQ(file.counts.cells_read, 6u);
  EXPECT_EQ(file.counts.cells_nan, 2u);
  EXPECT_EQ(file.mesh.original_cell, (std::vector<std::uint64_t>{0, 1, 4, 5}));
  EXPECT_EQ(file.mesh.tets[2], (scene::Tet{16, 17, 18, 19}));
  EXPECT_NE(file.notes.back().find("block 'shell' lacks the field 'p'"), std::string::npos);
}

/// Every seventh cell is a ghost, every eleventh has NaN, every thirteenth is a wedge on the points of two tets.
cells::CellBlock many_cells(std::size_t n) {
  cells::CellBlock block = with_types(row_of_tets(n));
  block.cell_ghost.assign(n, 0);
  std::vector<double> values(n);
  std::vector<std::uint32_t> connectivity;
  for (std::size_t c = 0; c < n; ++c) {
    block.cell_ghost[c] = c % 7 == 6 ? 1 : 0;
    values[c] = c % 11 == 10 ? nan : static_cast<double>(c);
    const bool wedge = c % 13 == 12;
    block.types[c] = wedge ? 13 : 10;
    const auto first = static_cast<std::uint32_t>(4 * c);
    if (wedge)
      for (const std::uint32_t v : {first, first + 1, first + 2, first - 4, first - 3, first - 2})
        connectivity.push_back(v);
    else
      for (std::uint32_t k = 0; k < 4; ++k) connectivity.push_back(first + k);
    block.offsets[c + 1] = connectivity.size();
  }
  block.connectivity = std::move(connectivity);
  block.fields = {cells::field_of_values("c", "double", Association::cell, 1, std::move(values))};
  return block;
}

TEST(MeshAssembly, ThreadsMakeTheSameMesh) {
  constexpr std::size_t n = 150'001;
  const auto assemble_with = [](int threads) {
    return scene::with_threads(threads, [] {
      return cells::assemble_mesh({many_cells(n), many_cells(n / 2), many_cells(20)}, {}, "mesh");
    });
  };
  const cells::MeshFile one = assemble_with(1);
  std::size_t tets = 0, t = 0;
  std::uint64_t cell = 0;
  for (const std::size_t cells : {n, n / 2, std::size_t{20}})
    for (std::size_t c = 0; c < cells; ++c, ++cell) {
      if (c % 7 == 6 || c % 11 == 10) continue;
      const std::size_t made = c % 13 == 12 ? 3 : 1;
      tets += made;
      for (; t < tets; ++t) {
        ASSERT_EQ(one.mesh.original_cell[t], cell) << t;
        ASSERT_EQ(one.mesh.scalars[t], static_cast<double>(c)) << t;
      }
    }
  EXPECT_EQ(one.mesh.tets.size(), tets);
  for (const int threads : {2, 0}) {
    const cells::MeshFile several = assemble_with(threads);
    EXPECT_EQ(several.mesh.tets, one.mesh.tets);
    EXPECT_EQ(several.mesh.original_cell, one.mesh.original_cell);
    EXPECT_EQ(several.mesh.scalars, one.mesh.scalars);
    EXPECT_EQ(several.counts, one.counts);
  }
}

TEST(MeshAssembly, TetsAreAsCellsOfTheirTypeWhicheverAreDropped) {
  constexpr std::size_t n = 40'000;
  for (const char* field : {"p", "c"})
    for (const int threads : {1, 2}) {
      ReadOptions options;
      options.field = field;
      for (const std::size_t dropped : {n, std::size_t{0}, std::size_t{20'000}, n - 1}) {
        cells::CellBlock some = row_of_tets(n);
        some.cell_ghost.assign(n, 0);
        if (dropped < n) some.cell_ghost[dropped] = 1;
        for (const std::size_t before : {std::size_t{0}, std::size_t{3}}) {
          const auto blocks = [&](const cells::CellBlock& block) {
            return before > 0 ? std::vector<cells::CellBlock>{row_of_tets(before), block, row_of_tets(2)}
                              : std::vector<cells::CellBlock>{block};
          };
          const auto assembled = [&](const cells::CellBlock& block) {
            return scene::with_threads(threads, [&] { return cells::assemble_mesh(blocks(block), options, "mesh"); });
          };
          const cells::MeshFile tets = assembled(some), cells = assembled(with_types(some));
          scene::validate(tets.mesh, "mesh");
          EXPECT_EQ(tets.mesh.tets.size(), n - (dropped < n ? 1 : 0) + (before > 0 ? before + 2 : 0));
          EXPECT_EQ(tets.mesh.tets, cells.mesh.tets);
          EXPECT_EQ(tets.mesh.scalars, cells.mesh.scalars);
          EXPECT_EQ(tets.mesh.original_cell, cells.mesh.original_cell);
          EXPECT_EQ(tets.counts, cells.counts);
        }
      }
    }
}

TEST(MeshAssembly, ReportsTheFirstBadCellWhicheverThreadFindsIt) {
  cells::CellBlock block = many_cells(200'000);
  for (const std::size_t c : {150'000, 90'001, 90'000}) block.types[c] = 42;
  for (int threads = 0; threads < 3; ++threads)
    scene::with_threads(threads, [&] {
      EXPECT_NE(message_of([&] { cells::assemble_mesh({block}, {}, "mesh"); }).find("cell 90000 is a polyhedron"),
                std::string::npos);
    });
}

TEST(MeshAssembly, MinusZeroAndZeroAreTheSamePosition) {
  cells::CellBlock block = row_of_tets(1);
  block.positions[0] = {-0.0, -0.0, -0.0};
  EXPECT_FALSE(std::signbit(assemble(block).mesh.positions[0].x));
}

/// Two tets on one face, with volumes in the ratio 1 : 3 and values 4 and 8.
cells::CellBlock two_tets(bool own_points) {
  cells::CellBlock block;
  const glm::dvec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), up(0, 0, 1), down(0, 0, -3);
  if (own_points) {
    block.positions = {a, b, c, up, b, a, c, down};
    block.tets = {{0, 1, 2, 3}, {4, 5, 6, 7}};
  } else {
    block.positions = {a, b, c, up, down};
    block.tets = {{0, 1, 2, 3}, {1, 0, 2, 4}};
  }
  block.fields.push_back(cells::field_of_values("c", "double", Association::cell, 1, {4, 8}));
  return block;
}

TEST(Smooth, WeightsByVolumeAndJoinsPointsByPosition) {
  ReadOptions options;
  options.smooth = true;
  for (const bool own : {false, true}) {
    const cells::MeshFile file = cells::assemble_mesh({two_tets(own)}, options, "mesh");
    scene::validate(file.mesh, "mesh");
    EXPECT_EQ(file.mesh.association, Association::point);
    for (std::size_t t = 0; t < 2; ++t)
      for (const std::uint32_t v : file.mesh.tets[t]) {
        const double z = file.mesh.positions[v].z;
        EXPECT_DOUBLE_EQ(file.mesh.scalars[v], z == 0 ? (1 * 4 + 3 * 8) / 4.0 : z > 0 ? 4 : 8);
      }
  }
}

TEST(Smooth, ASingleValueStaysThatValue) {
  cells::CellBlock block = two_tets(true);
  block.fields = {cells::field_of_values("c", "double", Association::cell, 1, {2.5, 2.5})};
  block.positions[3] = {0.25, 0.25, 0};  // a flat cell must not divide by its volume
  ReadOptions options;
  options.smooth = true;
  for (const double s : cells::assemble_mesh({block}, options, "mesh").mesh.scalars) EXPECT_EQ(s, 2.5);
}

}  // namespace
}  // namespace tessera::io
