// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/field_queries.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "api/query_data.hpp"
#include "datasets/modify.hpp"
#include "scene/error.hpp"
#include "support/temporary_folder.hpp"
#include "tessera/coarse_preview.hpp"
#include "tessera/session.hpp"
#include "tessera/write.hpp"

namespace tessera::field_queries_test {
namespace {

using tests::grid_of;
using tests::part_of;
using tests::with_field;

double x_of(const glm::dvec3& p) { return p.x; }

Dataset mesh_of_x() { return Dataset::of(datasets::arrays_of(with_field(datasets::cube(12), x_of))); }
Dataset grid_of_x() { return grid_of(33, x_of); }

double sum(const std::vector<double>& numbers) { return std::accumulate(numbers.begin(), numbers.end(), 0.0); }

TEST(Histogram, SharesAreThoseOfTheVolume) {
  for (const Dataset& data : {mesh_of_x(), grid_of_x()}) {
    const Histogram found = histogram(data, {.bins = 10});
    EXPECT_EQ(found.range, data.range());
    ASSERT_EQ(found.shares.size(), 10u);
    EXPECT_NEAR(sum(found.shares), 1, 1e-12);
    EXPECT_EQ(found.outside, 0);
    for (const double share : found.shares) EXPECT_NEAR(share, 0.1, 0.005);
  }
}

TEST(Histogram, CountsOnlyValuesInTheRange) {
  const Histogram found = histogram(mesh_of_x(), {.bins = 4, .range = {{0.0, 0.5}}});
  EXPECT_NEAR(sum(found.shares), 1, 1e-12);
  EXPECT_NEAR(found.outside, 0.75, 0.01);
  for (const double share : found.shares) EXPECT_NEAR(share, 0.25, 0.02);
  const Histogram none = histogram(mesh_of_x(), {.bins = 4, .range = {{7.0, 8.0}}});
  EXPECT_EQ(sum(none.shares), 0);
  EXPECT_EQ(none.outside, 1);
}

TEST(Histogram, GoesByTheLogarithm) {
  // The logarithm of 10^(2 x) is uniform over -2 to 2.
  const Dataset data = grid_of(65, [](const glm::dvec3& p) { return std::pow(10, 2 * p.x); });
  const Histogram found = histogram(data, {.bins = 8, .logarithmic = true});
  EXPECT_TRUE(found.logarithmic);
  for (const double share : found.shares) EXPECT_NEAR(share, 0.125, 0.01);
  // If the field's range begins at or below 0, the histogram begins at the smallest positive value.
  const Histogram of_x = histogram(grid_of_x(), {.bins = 8, .logarithmic = true});
  EXPECT_GT(of_x.range[0], 0);
  EXPECT_NEAR(of_x.outside, 0.5, 0.02);
  EXPECT_THROW((void)histogram(grid_of(4, [](const glm::dvec3& p) { return p.x - 2; }), {.logarithmic = true}), Error);
}

TEST(Histogram, LeavesBlanksOut) {
  const Dataset data = grid_of(33, [](const glm::dvec3& p) { return p.y > 0.01 ? NAN : p.y; });
  const Histogram found = histogram(data, {.bins = 2});
  EXPECT_NEAR(found.shares[0], 0.5, 0.02);
  EXPECT_NEAR(sum(found.shares), 1, 1e-12);
}

TEST(Histogram, OfAViewCountsVisibleValues) {
  View view{{}, {200, 100}};
  view.camera.position = {-0.5, 0, 5};
  view.camera.focal_point = {-0.5, 0, 0};
  view.camera.parallel_scale = 0.125;  // x from -0.75 to -0.25
  for (const Dataset& data : {mesh_of_x(), grid_of_x()}) {
    const Histogram found = histogram(data, {.bins = 8, .range = {{-1.0, 1.0}}, .seen = view});
    EXPECT_EQ(found.shares[0], 0);
    EXPECT_NEAR(found.shares[1], 0.5, 0.06);
    EXPECT_NEAR(found.shares[2], 0.5, 0.06);
    EXPECT_EQ(found.shares[3], 0);
    const double half = 0.5;
    EXPECT_NEAR(quantiles(data, std::span(&half, 1), view).front(), -0.5, 0.03);
    View past = view;
    past.camera.clipping_range = {6.5, 9};
    EXPECT_EQ(sum(histogram(data, {.seen = past}).shares), 0);
    EXPECT_TRUE(std::isnan(quantiles(data, std::span(&half, 1), past).front()));
  }
}

TEST(Histogram, OfOneValueHasARangeRoundIt) {
  const Histogram found = histogram(grid_of(5, [](const glm::dvec3&) { return 3.0; }), {.bins = 3});
  EXPECT_EQ(found.range, (std::array{2.5, 3.5}));
  EXPECT_EQ(found.shares, (std::vector<double>{0, 1, 0}));
}

TEST(Histogram, RefusesInvalidRanges) {
  const Dataset data = grid_of_x();
  EXPECT_THROW((void)histogram(data, {.range = {{1.0, 1.0}}}), Error);
  EXPECT_THROW((void)histogram(data, {.range = {{0.0, HUGE_VAL}}}), Error);
  EXPECT_THROW((void)histogram(data, {.bins = 0}), Error);
  EXPECT_THROW((void)histogram(data, {.seen = View{{}, {0, 3}}}), Error);
  const double beyond = 1.5;
  EXPECT_THROW((void)quantiles(data, std::span(&beyond, 1)), Error);
}

TEST(Quantiles, AreValuesWithThatFractionBelow) {
  for (const Dataset& data : {mesh_of_x(), grid_of_x()}) {
    const std::vector<double> values = quantiles(data, std::vector{0.5, 0.0, 1.0, 0.005, 0.995});
    EXPECT_NEAR(values[0], 0, 0.02);
    EXPECT_NEAR(values[1], -1, 0.02);
    EXPECT_NEAR(values[2], 1, 0.02);
    EXPECT_NEAR(values[3], -0.99, 0.01);
    EXPECT_NEAR(values[4], 0.99, 0.01);
  }
}

TEST(Histogram, IsTheSameOnEveryRankOfAnyNumber) {
  const scene::TetMesh mesh = with_field(datasets::cube(9), x_of);
  const Histogram alone = histogram(Dataset::of(datasets::arrays_of(mesh)));
  for (const int ranks : {2, 3})
    run_ranks(ranks, [&](const Communicator& communicator) {
      EXPECT_EQ(histogram(part_of(mesh, communicator)).shares, alone.shares);
    });
}

const TransferFunction soft({{-1, {0.1, 0.2, 0.9}, 0}, {-0.5, {0.1, 0.2, 0.9}, 0}, {1, {1, 0.4, 0.1}, 1.5}});

View view_from(const glm::dvec3& eye, bool perspective) {
  View view{{}, {48, 36}};
  view.camera.position = eye;
  view.camera.projection = perspective ? ProjectionKind::perspective : ProjectionKind::orthographic;
  view.camera.parallel_scale = 1.6;
  view.camera.view_angle = 40;
  return view;
}

/// Opacity along a ray up to a depth, from another image that ends there.
double opacity_up_to(const Dataset& data, const View& view, PixelIndex pixel, double depth, const Settings& settings) {
  View cut = view;
  cut.camera.clipping_range = {0, depth};
  const Image image = Session(data, settings).render(cut, soft).image;
  return image.rgba[4 * image.index(pixel.x, pixel.y) + 3];
}

/// `off`: allowed deviation of the field from x.
void expect_profile_holds(const RayProbe& probe, const Image& image, PixelIndex pixel, double off = 1e-5) {
  const std::size_t i = image.index(pixel.x, pixel.y);
  EXPECT_NEAR(probe.pixel.r, image.rgba[4 * i], 1e-4);
  EXPECT_NEAR(probe.pixel.g, image.rgba[4 * i + 1], 1e-4);
  EXPECT_NEAR(probe.pixel.b, image.rgba[4 * i + 2], 1e-4);
  EXPECT_NEAR(probe.pixel.a, image.rgba[4 * i + 3], 1e-4);
  if (!probe.opacity.empty()) {
    EXPECT_NEAR(probe.opacity.back(), probe.pixel.a, 1e-9);
    EXPECT_TRUE(std::ranges::is_sorted(probe.opacity));
    EXPECT_EQ(probe.opacity.front(), 0);
    EXPECT_TRUE(std::ranges::is_sorted(probe.depth));
  }
  ASSERT_EQ(probe.first.has_value(), std::isfinite(image.depth[i]));
  if (!probe.first) return;
  EXPECT_NEAR(probe.first->depth, image.depth[i], 1e-4);
  ASSERT_TRUE(probe.front && probe.half);
  EXPECT_LE(probe.first->depth, probe.front->depth);
  EXPECT_LE(probe.front->depth, probe.half->depth);
  // The field is x, and visible from -0.5 on.
  for (const RayPoint& point : {*probe.first, *probe.front, *probe.half}) {
    EXPECT_NEAR(point.value, point.position.x, off);
    EXPECT_GE(point.value, -0.5 - 1e-5);
  }
}

TEST(Probe, AgreesWithThePictureAndItsField) {
  int met = 0;
  for (const Dataset& data : {mesh_of_x(), grid_of_x()})
    for (const bool perspective : {false, true})
      for (const glm::dvec3& eye : {glm::dvec3(2, 1.4, 4), glm::dvec3(0, 0, 4)}) {
        const View view = view_from(eye, perspective);
        const Image image = Session(data).render(view, soft).image;
        for (int y = 1; y < 36; y += 7)
          for (int x = 1; x < 48; x += 6) {
            const RayProbe found = probe(data, view, soft, {x, y}, 33);
            expect_profile_holds(found, image, {x, y});
            for (std::size_t i = 0; i < found.depth.size(); ++i)
              EXPECT_NEAR(found.value[i],
                          found.value[0] + (found.value[32] - found.value[0]) * static_cast<double>(i) / 32, 1e-6);
            met += found.pixel.a > 0.1 ? 1 : 0;
          }
      }
  EXPECT_GT(met, 50);
}

TEST(Probe, OpacityDepthsMatchImagesThatEndThere) {
  for (const Dataset& data : {mesh_of_x(), grid_of_x()}) {
    const View view = view_from({2, 1.4, 4}, true);
    const PixelIndex pixel{24, 17};
    Settings settings;
    settings.integrator.kind = IntegratorKind::exact;
    const RayProbe found = probe(data, view, soft, pixel, 64, settings);
    ASSERT_TRUE(found.half);
    EXPECT_NEAR(opacity_up_to(data, view, pixel, found.half->depth, settings), found.pixel.a / 2, 2e-5);
    EXPECT_NEAR(opacity_up_to(data, view, pixel, found.front->depth, settings), found.pixel.a / 100, 2e-5);
    EXPECT_NEAR(opacity_up_to(data, view, pixel, found.depth[40], settings), found.opacity[40], 2e-5);
  }
}

TEST(Probe, GapsHaveNoValue) {
  scene::TetMesh mesh;
  for (const double at : {-1.0, 0.5}) {
    const scene::TetMesh box = datasets::regular_split(2, 2, 2, glm::dvec3(0.25), {-0.25, -0.25, at});
    mesh = mesh.tets.empty() ? box : datasets::merged({mesh, box});
  }
  const Dataset blocks = Dataset::of(datasets::arrays_of(with_field(mesh, x_of)));
  const Dataset blanks = grid_of(9, [](const glm::dvec3& p) { return std::abs(p.z) < 0.3 ? NAN : p.x; });
  for (const Dataset& data : {blocks, blanks}) {
    const RayProbe found = probe(data, view_from({0.05, 0.03, 4}, false), soft, {24, 18}, 201);
    EXPECT_TRUE(std::isnan(found.value[100]));
    EXPECT_EQ(found.opacity[95], found.opacity[105]);
    EXPECT_FALSE(std::isnan(found.value[0]));
    EXPECT_FALSE(std::isnan(found.value[200]));
    EXPECT_GT(found.opacity[200], found.opacity[105]);
  }
}

TEST(Probe, SeesSurfacesAndClips) {
  Settings settings;
  settings.surfaces.iso = {{0.2, glm::dvec3(1, 1, 1), 0.4}};
  const Dataset whole = mesh_of_x();
  Selection selection;
  selection.clip = {{{0, 0, 0.5}, {0, 0, -1}}};
  for (const Dataset& data : {whole, whole.selected(selection), grid_of_x()}) {
    settings.surfaces.boundary.clear();
    if (data.is_mesh()) settings.surfaces.boundary = {{glm::dvec3(0, 1, 0), 0.25}};
    const View view = view_from({3, 1.4, 4}, true);
    const Image image = Session(data, settings).render(view, soft).image;
    for (int x = 3; x < 48; x += 4) {
      const RayProbe found = probe(data, view, soft, {x, 17}, 100, settings);
      const std::size_t i = image.index(x, 17);
      EXPECT_NEAR(found.pixel.a, image.rgba[4 * i + 3], 1e-4);
      EXPECT_NEAR(found.pixel.g, image.rgba[4 * i + 1], 1e-4);
      EXPECT_NEAR(found.opacity.empty() ? found.pixel.a : found.opacity.back(), found.pixel.a, 1e-9);
    }
  }
}

/// A clip of a file's grid applies to all queries.
TEST(Probe, OfAClippedGridEndsAtThePlane) {
  const test::TemporaryFolder folder;
  write_grid(grid_of_x(), folder / "x.nrrd");
  ReadOptions options;
  options.selection.clip = {{{0.25, 0, 0}, {-1, 0, 0}}, {{0, 0, 0.5}, {0.2, 0, -1}}};
  const Dataset data = Dataset::open(folder / "x.nrrd", options);
  const std::optional<Dataset> coarse = coarse_preview(data, {.samples = 20 * 20 * 20});
  ASSERT_TRUE(coarse);
  EXPECT_EQ(coarse->bounds(), data.bounds());
  for (const Dataset& asked : {data, *coarse}) {
    const Histogram found = histogram(asked, {.bins = 8, .range = {{-1.0, 1.0}}});
    // The preview has fewer samples, each a mean, so it deviates by up to half of the distance between samples.
    const double off = asked.format() == data.format() ? 1e-5 : 0.04;
    EXPECT_LE(found.shares[5], off);
    EXPECT_EQ(found.shares[6] + found.shares[7], 0);
    EXPECT_NEAR(found.shares[2] / found.shares[1], 1, 0.1);
    const View view = view_from({2, 1.4, 4}, true);
    const Image image = Session(asked).render(view, soft).image;
    int met = 0;
    for (int x = 1; x < 48; x += 3) {
      const RayProbe probed = probe(asked, view, soft, {x, 17}, 40);
      expect_profile_holds(probed, image, {x, 17}, off);
      for (const double value : probed.value) EXPECT_LE(value, 0.25 + off);
      met += probed.pixel.a > 0.05 ? 1 : 0;
    }
    EXPECT_GT(met, 3);
  }
}

TEST(Probe, OfAPartMatchesTheWhole) {
  const scene::TetMesh mesh = with_field(datasets::cube(6), x_of);
  Settings settings;
  settings.surfaces.boundary = {{{}, 0.3}};
  const View view = view_from({2, 1.4, 4}, true);
  const RayProbe alone = probe(Dataset::of(datasets::arrays_of(mesh)), view, soft, {20, 15}, 50, settings);
  ASSERT_GT(alone.pixel.a, 0.3);
  run_ranks(3, [&](const Communicator& communicator) {
    const RayProbe found = probe(part_of(mesh, communicator), view, soft, {20, 15}, 50, settings, communicator);
    EXPECT_EQ(found.pixel.a, alone.pixel.a);
    EXPECT_EQ(found.opacity, alone.opacity);
    EXPECT_EQ(found.value, alone.value);
    EXPECT_EQ(found.half->depth, alone.half->depth);
  });
}

TEST(Probe, IncludesRanksWithoutCells) {
  scene::TetMesh one = datasets::cube(1);
  const std::vector<std::uint32_t> two_tets{0, 1};
  for (const scene::TetMesh& mesh :
       {scene::subset(one, two_tets), datasets::with_cell_data(scene::subset(one, two_tets))}) {
    const Dataset data = Dataset::of(datasets::arrays_of(mesh));
    const View view = data.default_view({9, 9});
    const RayProbe alone = probe(data, view, soft, {4, 4}, 9);
    const Dataset coarse = *coarse_preview(data, {.samples = 1000});
    run_ranks(4, [&](const Communicator& communicator) {
      const Dataset part = part_of(mesh, communicator);
      const RayProbe found = probe(part, view, soft, {4, 4}, 9, {}, communicator);
      EXPECT_EQ(found.pixel.a, alone.pixel.a);
      EXPECT_EQ(found.opacity, alone.opacity);
      EXPECT_EQ(coarse_preview(part, {.samples = 1000}, {}, communicator)->range(), coarse.range());
      EXPECT_EQ(histogram(part, {.bins = 3}).shares, histogram(data, {.bins = 3}).shares);
    });
  }
}

TEST(Probe, FindsNothingNextToTheData) {
  for (const Dataset& data : {mesh_of_x(), grid_of_x()}) {
    const RayProbe found = probe(data, view_from({0, 0, 4}, false), soft, {0, 0});
    EXPECT_EQ(found.pixel.a, 0);
    EXPECT_TRUE(std::isinf(found.pixel.z));
    EXPECT_FALSE(found.first || found.front || found.half);
    EXPECT_TRUE(found.depth.empty() && found.value.empty() && found.opacity.empty());
  }
}

TEST(Probe, RefusesInvalidPixels) {
  const Dataset data = grid_of_x();
  const View view = view_from({0, 0, 4}, false);
  for (const PixelIndex pixel : {PixelIndex{-1, 0}, PixelIndex{48, 0}, PixelIndex{0, 36}})
    EXPECT_THROW((void)probe(data, view, soft, pixel), Error);
  EXPECT_THROW((void)probe(data, view, soft, {0, 0}, 1), Error);
  EXPECT_THROW((void)probe(data, view, {}, {0, 0}), Error);
}

}  // namespace
}  // namespace tessera::field_queries_test
