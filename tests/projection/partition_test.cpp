// SPDX-License-Identifier: BSD-3-Clause
#include "projection/partition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "datasets/boxes.hpp"

namespace tessera::projection::partition_test {
namespace {

const scene::Box unit_box{glm::dvec3(0), glm::dvec3(1)};

TEST(Partition, FileOrderGivesContiguousRangesThatDifferByOneAtMost) {
  for (const std::uint64_t total : {0u, 1u, 5u, 7u, 100u})
    for (const int parts : {1, 2, 3, 7, 11}) {
      EXPECT_EQ(first_in_file_order(0, total, parts), 0u);
      EXPECT_EQ(first_in_file_order(parts, total, parts), total);
      for (int p = 0; p < parts; ++p) {
        const std::uint64_t begin = first_in_file_order(p, total, parts),
                            end = first_in_file_order(p + 1, total, parts);
        EXPECT_LE(end - begin, total / static_cast<std::uint64_t>(parts) + 1);
        EXPECT_GE(end - begin, total / static_cast<std::uint64_t>(parts));
        for (std::uint64_t t = begin; t < end; ++t) EXPECT_EQ(part_in_file_order(t, total, parts), p);
      }
    }
  EXPECT_EQ(part_in_file_order((1ull << 40) - 1, 1ull << 40, 64), 63);
}

TEST(Partition, RandomIsBalancedSeededAndIndependentOfNeighbours) {
  constexpr int parts = 7, n = 70000;
  std::array<int, parts> size{};
  int same_as_next_tet = 0, same_as_next_seed = 0;
  for (std::uint64_t t = 0; t < n; ++t) {
    const int p = part_at_random(t, 5, parts);
    ASSERT_TRUE(p >= 0 && p < parts);
    ++size[static_cast<std::size_t>(p)];
    same_as_next_tet += p == part_at_random(t + 1, 5, parts);
    same_as_next_seed += p == part_at_random(t, 6, parts);
  }
  // The numbers are binomially distributed with a standard deviation of 93. The tolerance is five standard deviations.
  for (const int s : size) EXPECT_NEAR(s, n / parts, 465);
  EXPECT_NEAR(same_as_next_tet, n / parts, 465);
  EXPECT_NEAR(same_as_next_seed, n / parts, 465);
}

TEST(Curve, VisitsEveryCellOfAGridOnceInStepsToANeighbour) {
  // A curve that respects the halves at every level visits the 2^3k cells of a coarse grid in contiguous intervals.
  constexpr int n = 8;
  std::vector<std::pair<std::uint64_t, std::array<int, 3>>> cells;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        cells.push_back({curve_place((glm::dvec3(i, j, k) + 0.5) / double(n), unit_box), {i, j, k}});
  std::sort(cells.begin(), cells.end());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    EXPECT_EQ(cells[c].first >> (63 - 9), c);  // nine bits of the key: the index of the cell
    if (c == 0) continue;
    int steps = 0;
    for (std::size_t a = 0; a < 3; ++a) steps += std::abs(cells[c].second[a] - cells[c - 1].second[a]);
    EXPECT_EQ(steps, 1) << "cell " << c;
  }
}

TEST(Curve, ExtremeCoordinatesHaveKeys) {
  EXPECT_EQ(curve_place({3, 4, 5}, {glm::dvec3(3, 4, 5), glm::dvec3(3, 4, 5)}), 0u);
  EXPECT_EQ(curve_place({0.5, 0.5, 0.5}, scene::Box{}), 0u);
  EXPECT_LT(curve_place({9, 9, 9}, unit_box), 1ull << 63);
  EXPECT_EQ(curve_place({9, 9, 9}, unit_box), curve_place({1, 1, 1}, unit_box));
  EXPECT_EQ(curve_place({-9, -9, -9}, unit_box), curve_place({0, 0, 0}, unit_box));
}

/// The splitters if the keys are on `ranks` processes, distributed by `random`.
std::vector<CurveKey> cut(const std::vector<CurveKey>& keys, int parts, std::size_t ranks, unsigned seed, int* rounds) {
  std::mt19937 random(seed);
  std::vector<std::vector<CurveKey>> held(ranks);
  for (const CurveKey& key : keys) held[random() % ranks].push_back(key);
  CurveCut cut(keys.size(), parts);
  *rounds = 0;
  while (!cut.done()) {
    std::vector<std::uint64_t> sum;
    for (const auto& own : held) {
      const auto counts = cut.count(own);
      sum.resize(counts.size());
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += counts[k];
    }
    cut.narrow(sum);
    ++*rounds;
  }
  return cut.splitters();
}

void expect_balanced(const std::vector<CurveKey>& keys, int parts, int most_rounds) {
  SCOPED_TRACE(testing::Message() << keys.size() << " tets in " << parts << " parts");
  int rounds = 0;
  const auto splitters = cut(keys, parts, 1, 1, &rounds);
  EXPECT_LE(rounds, most_rounds);
  EXPECT_EQ(splitters.size(), static_cast<std::size_t>(parts) - 1);
  EXPECT_TRUE(std::is_sorted(splitters.begin(), splitters.end()));
  for (const std::size_t ranks : {2, 5}) EXPECT_EQ(cut(keys, parts, ranks, 3, &rounds), splitters);
  std::vector<std::uint64_t> size(static_cast<std::size_t>(parts), 0);
  for (const CurveKey& key : keys) ++size[static_cast<std::size_t>(part_on_curve(key, splitters))];
  const double even = static_cast<double>(keys.size()) / parts;
  for (const std::uint64_t s : size) EXPECT_LE(std::abs(static_cast<double>(s) - even), std::max(0.01 * even, 1.0));
}

TEST(Curve, PartsAreBalancedForAnyDistributionOfTets) {
  for (const scene::TetMesh& mesh : {datasets::cube(12), datasets::graded(8, 1e12), datasets::thin_stack(500)}) {
    const auto keys = curve_keys(mesh, {}, scene::bounds(mesh));
    for (const int parts : {1, 2, 3, 8, 61}) expect_balanced(keys, parts, 15);
  }
  const scene::TetMesh large = datasets::cube(30);
  expect_balanced(curve_keys(large, {}, scene::bounds(large)), 4, 2);  // two rounds, as usual
}

TEST(Curve, TetsAtOnePlaceAreCutByTheirIndex) {
  std::vector<CurveKey> keys;
  for (std::uint64_t t = 0; t < 1000; ++t) keys.push_back({123456789, 7 * t});
  for (const int parts : {2, 3, 999, 1000, 1003}) expect_balanced(keys, parts, 15);
}

TEST(Curve, FewerTetsThanPartsLeaveSomeEmpty) {
  std::vector<CurveKey> keys = {{5, 0}, {~0ull, ~0ull}};
  for (const int parts : {2, 3, 5}) expect_balanced({keys.begin(), keys.begin() + 1}, parts, 15);
  for (const int parts : {2, 3, 5}) expect_balanced(keys, parts, 16);
  expect_balanced({}, 3, 15);
}

TEST(Curve, PartsOfACubeAreCompact) {
  // Eight parts of a cube by the curve are its octants; their boxes together have its volume, those of random parts
  // eight times that.
  const scene::TetMesh mesh = datasets::cube(16, 0);
  const auto keys = curve_keys(mesh, {}, scene::bounds(mesh));
  int rounds = 0;
  const auto splitters = cut(keys, 8, 1, 1, &rounds);
  std::array<scene::TetMesh, 8> part;
  for (auto& p : part) p.positions = mesh.positions;
  for (std::size_t t = 0; t < keys.size(); ++t)
    part[static_cast<std::size_t>(part_on_curve(keys[t], splitters))].tets.push_back(mesh.tets[t]);
  double volume = 0;
  for (const auto& p : part) {
    const scene::Box box = scene::bounds(p);
    volume += (box.high.x - box.low.x) * (box.high.y - box.low.y) * (box.high.z - box.low.z);
  }
  EXPECT_LT(volume, 1.5 * 8);  // a part's box has one more layer of cells where the cut is off by 0.4 %
}

TEST(Partition, OfAWholeMeshIsTheRulesOwn) {
  const scene::TetMesh mesh = datasets::cube(3);
  const auto file = parts_of_whole(mesh, {PartitionKind::file, 1}, 5),
             random = parts_of_whole(mesh, {PartitionKind::random, 9}, 5),
             curve = parts_of_whole(mesh, {PartitionKind::curve, 1}, 5);
  const auto keys = curve_keys(mesh, {}, scene::bounds(mesh));
  int rounds = 0;
  const auto splitters = cut(keys, 5, 3, 2, &rounds);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    EXPECT_EQ(static_cast<int>(file[t]), part_in_file_order(t, mesh.tets.size(), 5));
    EXPECT_EQ(static_cast<int>(random[t]), part_at_random(t, 9, 5));
    EXPECT_EQ(static_cast<int>(curve[t]), part_on_curve(keys[t], splitters));
  }
}

TEST(Curve, KeysCarryTheGivenIndices) {
  const scene::TetMesh mesh = datasets::cube(1);
  const std::vector<std::uint64_t> ids = {10, 20, 30, 40, 50, 60};
  const auto keys = curve_keys(mesh, ids, scene::bounds(mesh)), whole = curve_keys(mesh, {}, scene::bounds(mesh));
  for (std::size_t t = 0; t < 6; ++t) {
    EXPECT_EQ(keys[t].tet, ids[t]);
    EXPECT_EQ(whole[t].tet, t);
    EXPECT_EQ(keys[t].place, whole[t].place);
  }
}

}  // namespace
}  // namespace tessera::projection::partition_test
