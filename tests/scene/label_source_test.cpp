// SPDX-License-Identifier: BSD-3-Clause
#include "scene/label_source.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace tessera::scene::label_source_test {
namespace {

constexpr std::int64_t side = 24;

/// A cube of side^3 points with one value per point.
template <class Value>
std::shared_ptr<const SampleSource> cube_of(const Value& value) {
  Grid grid;
  grid.geometry.points = {side, side, side};
  grid.type = SampleType::float64;
  std::vector<double> samples;
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) samples.push_back(value(i, j, k));
  return MemorySource::of(std::move(grid), std::move(samples), "cube");
}

/// Boxes of 4^3 samples, numbered from 1.
int box_at(int i, int j, int k) { return 1 + i / 4 + 6 * (j / 4) + 36 * (k / 4); }

TEST(LabelValues, AreWholeNumbersThatNeighboursShare) {
  const LabelValues few = label_values(
      *cube_of([](int i, int j, int k) { return box_at(i, j, k) % 5 == 0 ? 9.0 : box_at(i, j, k) % 2; }), false);
  EXPECT_TRUE(few.are_labels);
  EXPECT_EQ(few.values, (std::vector<double>{0, 1, 9}));
  const LabelValues many = label_values(*cube_of([](int i, int j, int k) { return 7.0 * box_at(i, j, k); }), false);
  EXPECT_TRUE(many.are_labels);
  EXPECT_EQ(many.values.size(), 216u);
}

TEST(LabelValues, OneBlankSampleChangesNothing) {
  const auto with = [](double odd) {
    return label_values(
        *cube_of([odd](int i, int j, int k) { return i == 5 && j == 6 && k == 7 ? odd : double(box_at(i, j, k)); }),
        false);
  };
  EXPECT_EQ(with(std::nan("")).values, with(box_at(5, 6, 7)).values);
  EXPECT_TRUE(with(std::nan("")).are_labels);
  EXPECT_EQ(with(1e20).values, with(box_at(5, 6, 7)).values);  // a fill value
  EXPECT_FALSE(with(0.5).are_labels);
}

TEST(LabelValues, AreNotNoiseNorQuantizedFieldsNorMasks) {
  std::mt19937 random(7);
  EXPECT_FALSE(label_values(*cube_of([&](int, int, int) { return double(random() % 9); }), false).are_labels);
  EXPECT_FALSE(label_values(*cube_of([&](int, int, int) { return double(random() % 3000); }), false).are_labels);
  EXPECT_FALSE(label_values(*cube_of([](int i, int j, int k) {
                 return std::floor(127 + 120 * std::sin(0.2 * i) * std::cos(0.15 * j) * std::cos(0.1 * k));
               }),
                            false)
                   .are_labels);
  const auto mask = cube_of([](int i, int, int) { return i < 9 ? 0.0 : 1.0; });
  EXPECT_FALSE(label_values(*mask, false).are_labels);
  const LabelValues stated = label_values(*mask, true);  // unless the header declares them
  EXPECT_TRUE(stated.are_labels);
  EXPECT_EQ(stated.values, (std::vector<double>{0, 1}));
  EXPECT_TRUE(label_values(*cube_of([&](int, int, int) { return double(random()); }), true).values.empty());
}

TEST(LabelSource, SamplesFillTheVoxelsRoundThem) {
  Grid grid;
  grid.geometry.points = {3, 2, 4};
  grid.geometry.origin = {10, 20, 30};
  grid.geometry.spacing = {2, 3, 4};
  grid.geometry.direction = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
  grid.geometry.coordinates[2] = {0, 1, 3, 7};
  std::vector<double> samples(24);
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k] = static_cast<double>(k);
  const std::shared_ptr<const SampleSource> points = MemorySource::of(grid, samples, "points");
  const LabelSource cells(points, "cells");
  const GridGeometry& g = cells.geometry();
  EXPECT_EQ(g.association, Association::cell);
  EXPECT_EQ(g.samples(), (GridIndex{3, 2, 4}));
  EXPECT_EQ(g.coordinates[2], (std::vector<double>{-0.5, 0.5, 2, 5, 9}));
  EXPECT_EQ(world_of_index(g, {0.5, 0.5, 0.5}), world_of_index(points->geometry(), {0, 0, 0}));
  EXPECT_EQ(world_of_index(g, {2.5, 1.5, 0.5}), world_of_index(points->geometry(), {2, 1, 0}));
  std::vector<double> read(24), part(4);
  cells.read(g.all_samples(), std::span<double>(read));
  EXPECT_EQ(read, samples);
  cells.read(SampleBox{{1, 0, 2}, {3, 2, 3}}, std::span<double>(part));
  EXPECT_EQ(part, (std::vector<double>{13, 14, 16, 17}));
}

}  // namespace
}  // namespace tessera::scene::label_source_test
