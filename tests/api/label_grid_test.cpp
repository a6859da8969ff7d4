// SPDX-License-Identifier: BSD-3-Clause
// Labels at points look like the same labels in cells: no colors between two labels, and none that the file does not
// have.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"
#include "tessera/dataset.hpp"
#include "tessera/session.hpp"
#include "tessera/write.hpp"

namespace tessera::label_grid_test {
namespace {

constexpr std::int64_t side = 12;

/// Two nested balls with values 1 and 9, in empty space.
std::vector<float> balls() {
  std::vector<float> samples;
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const double r = std::hypot(i - 5.5, j - 5.5, k - 5.5);
        samples.push_back(r < 2.5 ? 9.0F : r < 5 ? 1.0F : 0.0F);
      }
  return samples;
}

std::filesystem::path write(const test::TemporaryFolder& folder, const char* name, Association association,
                            const std::vector<float>& samples) {
  GridArrays arrays;
  const std::int64_t points = association == Association::cell ? side + 1 : side;
  arrays.geometry.points = {points, points, points};
  arrays.geometry.association = association;
  arrays.samples = samples;
  arrays.field_name = "region";
  write_grid(Dataset::of(arrays), folder / name);
  return folder / name;
}

Image picture(const Dataset& data) {
  const View view = data.default_view({64, 64});
  Session session(data, {});
  return session.render(view, data.transfer_function().function).image;
}

void expect_same_picture(const Image& a, const Image& b) {
  ASSERT_EQ(a.rgba.size(), b.rgba.size());
  double most = 0, light = 0;
  for (std::size_t k = 0; k < a.rgba.size(); ++k) {
    most = std::max(most, std::abs(double(a.rgba[k]) - double(b.rgba[k])));
    light += a.rgba[k];
  }
  EXPECT_LT(most, 2e-5);
  EXPECT_GT(light, 1);  // something is visible
}

TEST(LabelGrid, AtPointsLooksAsInCells) {
  const test::TemporaryFolder folder;
  const Dataset points = Dataset::open(write(folder, "p.nrrd", Association::point, balls()));
  const Dataset cells = Dataset::open(write(folder, "c.vti", Association::cell, balls()));
  EXPECT_EQ(points.transfer_function().name, cells.transfer_function().name);
  expect_same_picture(picture(points), picture(cells));
  const auto function = points.transfer_function().function;
  for (int absent = 2; absent < 9; ++absent) EXPECT_EQ(function.evaluate(absent).extinction, 0) << absent;
}

TEST(LabelGrid, ABlankSampleLeavesOutItsVoxelAlone) {
  const test::TemporaryFolder folder;
  std::vector<float> samples = balls();
  samples[0] = std::nanf("");  // in a corner, where nothing is visible
  const Dataset blank = Dataset::open(write(folder, "b.nrrd", Association::point, samples));
  const Dataset whole = Dataset::open(write(folder, "w.nrrd", Association::point, balls()));
  EXPECT_EQ(blank.transfer_function().name, whole.transfer_function().name);
  expect_same_picture(picture(blank), picture(whole));
}

TEST(LabelGrid, CanBeInterpolatedAndIsWrittenAsItWas) {
  const test::TemporaryFolder folder;
  const auto file = write(folder, "p.nrrd", Association::point, balls());
  ReadOptions options;
  options.labels = false;
  const Dataset smooth = Dataset::open(file, options);
  EXPECT_EQ(smooth.grid_geometry().association, Association::point);
  const Dataset labels = Dataset::open(file);
  EXPECT_EQ(labels.grid_geometry().association, Association::cell);
  write_grid(labels, folder / "again.nrrd");
  EXPECT_EQ(test::contents(folder / "again.nrrd"), test::contents(file));
}

}  // namespace
}  // namespace tessera::label_grid_test
