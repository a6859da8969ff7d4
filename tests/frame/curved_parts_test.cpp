// SPDX-License-Identifier: BSD-3-Clause
// A caller's higher-order cells in parts, one per rank: shared faces are divided in the same way as in one process.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "api/communicator.hpp"
#include "exchange/loopback_transport.hpp"
#include "support/curved_meshes.hpp"
#include "support/some_cases.hpp"
#include "tessera/dataset.hpp"

namespace tessera::frame::curved_parts_test {
namespace {

/// A tet as its corners' positions and values, in a fixed order.
using Corners = std::array<std::array<double, 4>, 4>;

std::vector<Corners> tets_of(const Dataset& data) {
  const MeshArrays arrays = data.mesh_arrays();
  const auto points = arrays.points.as<double>(), scalars = arrays.scalars.as<double>();
  const auto tets = arrays.tets.as<std::uint32_t>();
  std::vector<Corners> all;
  for (std::size_t t = 0; t < tets.size(); t += 4) {
    Corners& corners = all.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t v = tets[t + k];
      corners[k] = {points[3 * v], points[3 * v + 1], points[3 * v + 2], scalars[v]};
    }
    std::sort(corners.begin(), corners.end());
  }
  return all;
}

/// Some of a block's cells; each has its own points.
struct Cells {
  Cells(const cells::CellBlock& block, std::size_t first, std::size_t last) {
    std::vector<double> values(block.positions.size());
    block.fields.front().read(0, 0, values);
    for (std::size_t c = first; c < last; ++c) {
      types.push_back(block.types[c]);
      for (std::size_t k = block.offsets[c]; k < block.offsets[c + 1]; ++k) {
        const std::uint32_t v = block.connectivity[k];
        connectivity.push_back(static_cast<std::uint32_t>(points.size() / 3));
        for (int x = 0; x < 3; ++x) points.push_back(block.positions[v][x]);
        scalars.push_back(values[v]);
      }
      offsets.push_back(connectivity.size());
    }
  }

  [[nodiscard]] MeshArrays arrays(double tolerance, std::uint64_t tets) const {
    MeshArrays result;
    result.points = std::span<const double>(points);
    if (!types.empty()) {
      result.types = std::span<const std::uint8_t>(types);
      result.offsets = std::span<const std::uint64_t>(offsets);
      result.connectivity = std::span<const std::uint32_t>(connectivity);
    }
    result.scalars = std::span<const double>(scalars);
    result.higher_order_tolerance = tolerance;
    result.higher_order_tets = tets;
    return result;
  }

  std::vector<double> points, scalars;
  std::vector<std::uint8_t> types;
  std::vector<std::uint64_t> offsets{0};
  std::vector<std::uint32_t> connectivity;
};

TEST(CurvedParts, MatchTheDivisionOfTheWhole) {
  // Steep only at one end: parts differ in range and number of tets.
  const auto field = [](const glm::dvec3& p) { return std::exp(4 * p.x) + std::sin(5 * p.y * p.z); };
  test::SomeCases some(4);
  for (const io::testing::Kind& kind : {io::testing::Kind{24, 10, 2}, {72, 27, 2}})
    for (const std::uint64_t most_tets : {std::uint64_t{1} << 21, std::uint64_t{2000}}) {
      const cells::CellBlock block = io::testing::warped_box(kind, 2, io::testing::bent, field, true);
      const std::size_t cells = block.types.size();
      const Dataset whole = Dataset::of(Cells(block, 0, cells).arrays(1e-3, most_tets));
      std::vector<Corners> expected = tets_of(whole);
      std::sort(expected.begin(), expected.end());
      for (const int ranks : {4, 3, 2, 1}) {
        if (!some.next()) continue;
        SCOPED_TRACE(::testing::Message() << "type " << int{kind.type} << ", " << most_tets << " tets, " << ranks);
        std::mutex mutex;
        std::vector<Corners> found;
        exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
          // With four ranks, the last one has no cells. Rank 1 has a larger limit, which has no effect because the
          // smallest applies.
          const auto self = static_cast<std::size_t>(transport.rank()),
                     parts = static_cast<std::size_t>(std::min(ranks, 3));
          const auto first = [&](std::size_t part) { return std::min(cells, cells * part / parts); };
          const Cells own(block, first(self), first(self + 1));
          const MeshArrays part = own.arrays(self == 1 ? 1e-2 : 1e-3, most_tets);
          const Dataset data = Dataset::of_parts(part, api::communicator_over(transport));
          EXPECT_EQ(data.higher_order_cells(), whole.higher_order_cells());
          EXPECT_EQ(data.mesh_counts().cells_read, cells);
          const std::vector<Corners> mine = tets_of(data);
          const std::scoped_lock lock(mutex);
          found.insert(found.end(), mine.begin(), mine.end());
        });
        std::sort(found.begin(), found.end());
        EXPECT_TRUE(found == expected) << found.size() << " tets, " << expected.size() << " of the whole";
      }
    }
}

// This must hold whether the arrays are borrowed or converted, and for any distribution of the cells over ranks.
TEST(CurvedParts, CellsGivenTwiceAreCounted) {
  const std::vector<double> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, scalars = {0, 1, 2, 3, 4};
  const std::vector<std::uint32_t> tets = {0, 1, 2, 3, 1, 2, 3, 4, 2, 1, 0, 3, 0, 1, 2, 4, 3, 2, 1, 0};
  const std::vector<std::int64_t> wide(tets.begin(), tets.end());
  const auto arrays = [&](std::size_t first, std::size_t last, bool is_borrowed) {
    MeshArrays result;
    result.points = std::span<const double>(points);
    result.scalars = std::span<const double>(scalars);
    if (is_borrowed)
      result.tets = std::span(tets).subspan(4 * first, 4 * (last - first));
    else
      result.tets = std::span(wide).subspan(4 * first, 4 * (last - first));
    return result;
  };
  for (const bool is_borrowed : {true, false})
    for (const int ranks : {1, 2, 3, 5, 6}) {
      SCOPED_TRACE(::testing::Message() << is_borrowed << ", " << ranks);
      exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
        const auto self = static_cast<std::size_t>(transport.rank()), parts = static_cast<std::size_t>(ranks);
        const Dataset data = Dataset::of_parts(arrays(5 * self / parts, 5 * (self + 1) / parts, is_borrowed),
                                               api::communicator_over(transport));
        EXPECT_EQ(data.mesh_counts().cells_read, 5u);
        EXPECT_EQ(data.mesh_counts().cells_duplicate, 2u);
        ASSERT_FALSE(data.warnings().empty());
        EXPECT_EQ(data.warnings().front().find("2 cells have the corners of other cells"), 0u);
      });
    }
}

}  // namespace
}  // namespace tessera::frame::curved_parts_test
