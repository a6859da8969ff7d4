// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/peel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "api/dataset.hpp"
#include "api/query_data.hpp"
#include "datasets/arrays.hpp"
#include "datasets/modify.hpp"
#include "datasets/shapes.hpp"
#include "datasets/transfer_functions.hpp"
#include "reference/grid/grid_reference.hpp"
#include "reference/reference.hpp"
#include "scene/error.hpp"
#include "support/deep_pixels.hpp"
#include "support/some_cases.hpp"
#include "tessera/communicator.hpp"
#include "tessera/session.hpp"

/// Opacity peeling: every layer equals the reference's layer, the composited layers equal the image, and the bits do
/// not depend on the numbers of ranks and threads.
namespace tessera::peel_test {
namespace {

constexpr ImageSize size{43, 37};

View view_of(ProjectionKind kind, const glm::dvec3& eye = {3.1, 2.3, 4.2}) {
  Camera camera;
  camera.position = eye;
  camera.parallel_scale = 1.6;
  camera.projection = kind;
  camera.view_angle = 38;
  return {camera, size};
}

Settings exact(int threads = 2) {
  Settings settings;
  settings.integrator.kind = IntegratorKind::exact;
  settings.threads = threads;
  return settings;
}

FrameSettings peeled(double threshold, int layers, bool deep = false) {
  FrameSettings settings;
  settings.peel = Peel{threshold, layers};
  settings.deep = deep;
  return settings;
}

double waves(const glm::dvec3& p) { return 0.5 + 0.5 * std::sin(3 * p.x + p.y) * std::cos(2 * p.z - p.x * p.y); }

/// Samples over [-1, 1]^3, of cells or at points, uniform or not, one of them blank.
Dataset grid(Association association, bool rectilinear) {
  GridArrays arrays;
  arrays.geometry.association = association;
  arrays.geometry.points = {12, 11, 13};
  arrays.geometry.origin = glm::dvec3(-1);
  arrays.geometry.spacing = glm::dvec3(2 / 11., 2 / 10., 2 / 12.);
  if (rectilinear) arrays.geometry.coordinates[1] = {0, 0.1, 0.15, 0.4, 0.8, 0.9, 1.3, 1.35, 1.6, 1.9, 2};
  auto samples = std::make_shared<std::vector<float>>();
  std::mt19937 random(5);
  const auto count = static_cast<std::size_t>(arrays.geometry.all_samples().count());
  for (std::size_t i = 0; i < count; ++i) samples->push_back(std::uniform_real_distribution<float>(0, 1)(random));
  (*samples)[count / 2] = NAN;
  arrays.samples = *samples;
  arrays.owner = samples;
  return Dataset::of(arrays);
}

/// Compares the composited layers with the image.
void expect_the_image(const RenderedFrame& frame, double bound) {
  for (std::size_t p = 0; p < frame.image.depth.size(); ++p) {
    std::array<double, 4> sum{};
    for (const Image& layer : frame.layers) {
      const double through = 1 - sum[3];
      for (std::size_t c = 0; c < 4; ++c) sum[c] += through * layer.rgba[4 * p + c];
    }
    for (std::size_t c = 0; c < 4; ++c) ASSERT_NEAR(sum[c], frame.image.rgba[4 * p + c], bound) << p;
    ASSERT_TRUE(std::isinf(frame.image.depth[p]) || std::isfinite(frame.layers[0].depth[p])) << p;
  }
}

/// Every pixel of every layer is within 1e-5 of the reference, except at most one in a hundred pixels, whose neighbours
/// differ.
void expect_the_reference(const Dataset& data, const Settings& settings, const View& view,
                          const TransferFunction& function, double threshold, int layers) {
  SCOPED_TRACE(::testing::Message() << "threshold " << threshold << ", layers " << layers);
  Session session(data, settings);
  const RenderedFrame frame = session.render(view, function, peeled(threshold, layers));
  ASSERT_EQ(frame.layers.size(), static_cast<std::size_t>(layers));
  expect_the_image(frame, 2e-5);
  const Verification found = session.verify(frame, view, function, frame.image.depth.size());
  ASSERT_EQ(found.layers.size(), frame.layers.size());
  EXPECT_EQ(found.layer_bound, 1e-5);
  for (const Verification::Tally& layer : found.layers) {
    EXPECT_EQ(layer.pixels, frame.image.depth.size());
    EXPECT_EQ(layer.over_bound, layer.excused) << layer.reason << ": " << layer.max_error;
    EXPECT_LE(layer.excused, layer.pixels / 100) << layer.reason;
  }
}

std::size_t seen(const Image& layer) {
  return static_cast<std::size_t>(std::ranges::count_if(layer.depth, [](float z) { return std::isfinite(z); }));
}

std::vector<TransferFunction> functions() {
  const TransferFunction usual = datasets::benchmark_transfer_function();
  return {datasets::scaled(usual, 0.3), datasets::scaled(usual, 8), datasets::step_knots(6, {0, 1}, 30),
          TransferFunction({{0.5, {0.9, 0.5, 0.1}, 900}})};
}

TEST(Peel, LayersOfMeshesMatchTheReference) {
  const scene::TetMesh points = tests::with_field(datasets::cube(5), waves);
  for (const scene::TetMesh& mesh : {points, datasets::with_cell_data(points), datasets::shells(3, 1, 1)}) {
    const Dataset data = Dataset::of(datasets::arrays_of(mesh));
    for (const TransferFunction& function : functions()) {
      expect_the_reference(data, exact(), view_of(ProjectionKind::orthographic), function, 0.1, 7);
      expect_the_reference(data, exact(), view_of(ProjectionKind::perspective), function, 0.6, 3);
      expect_the_reference(data, exact(), view_of(ProjectionKind::perspective, {0.1, 0.2, 0.15}), function, 0.99, 2);
    }
  }
}

// Only some cells need double precision, even if matter is lit or a function is steep.
TEST(Peel, LayersOfMeshesAreMadeOnTheLattice) {
  const Dataset data = Dataset::of(datasets::arrays_of(tests::with_field(datasets::cube(8), waves)));
  const View view = view_of(ProjectionKind::perspective);
  const TransferFunction steep({{0, {0.9, 0.2, 0.1}, 0.1}, {1e-9, {0.1, 0.2, 0.9}, 3}, {1, {0.2, 0.9, 0.5}, 6}});
  for (const TransferFunction& function : {datasets::benchmark_transfer_function(), steep})
    for (const bool shaded : {false, true}) {
      Settings settings = exact();
      if (shaded) settings.mesh.shading.emplace();
      expect_the_reference(data, settings, view, function, 0.3, 4);
      const FrameCounters made = Session(data, settings).render(view, function, peeled(0.3, 4)).statistics.mesh;
      EXPECT_LT(made.segments_in_double_precision, made.segments / 2) << shaded;
      EXPECT_GT(made.segments, 0u);
    }
}

// In dense matter, a segment may be opaque in single precision and hide all segments behind it.
TEST(Peel, LayersOfDenseMatterMatchTheReference) {
  const Dataset data = Dataset::of(datasets::arrays_of(datasets::cube(4)));
  for (const double extinction : {30.0, 100.0, 300.0, 600.0}) {
    const TransferFunction ramp({{0, {0.9, 0.5, 0.1}, 0}, {1, {0.1, 0.8, 0.6}, extinction}});
    for (const double threshold : {0.5, 0.9, 0.999})
      expect_the_reference(data, exact(), view_of(ProjectionKind::orthographic), ramp, threshold, 3);
  }
}

TEST(Peel, LayersOfGridsMatchTheReference) {
  test::SomeCases some(3);
  for (const auto association : {Association::point, Association::cell})
    for (const bool rectilinear : {false, true}) {
      const Dataset data = grid(association, rectilinear);
      for (const TransferFunction& function : functions()) {
        if (!some.next()) continue;
        expect_the_reference(data, exact(), view_of(ProjectionKind::orthographic), function, 0.1, 7);
        expect_the_reference(data, exact(), view_of(ProjectionKind::perspective), function, 0.6, 3);
        expect_the_reference(data, exact(), view_of(ProjectionKind::perspective, {0.1, 0.2, 0.15}), function, 0.99, 2);
      }
    }
}

/// Where the extinction is almost zero at the boundary of two layers, rounding moves the boundary.
TEST(Peel, LayersBeginAtTheReferencesDepths) {
  const TransferFunction function = datasets::scaled(datasets::benchmark_transfer_function(), 8);
  const View view = view_of(ProjectionKind::perspective);
  const Peel peel{0.6, 4};
  const auto expect = [&](const Dataset& data, const reference::LayerReference& reference) {
    const RenderedFrame frame = Session(data, exact()).render(view, function, peeled(peel.threshold, peel.layers));
    const auto truth = reference.layers(reference::all_pixels(size), peel);
    std::size_t elsewhere = 0;
    for (std::size_t p = 0; p < truth.size(); ++p)
      for (std::size_t n = 0; n < truth[p].size(); ++n) {
        const double z = truth[p][n].z, found = frame.layers[n].depth[p];
        if (std::isfinite(z) != std::isfinite(found) || std::abs(z - found) > 1e-5) ++elsewhere;
      }
    EXPECT_LE(elsewhere, truth.size() / 100);
  };
  const scene::TetMesh mesh = tests::with_field(datasets::cube(5), waves);
  expect(Dataset::of(datasets::arrays_of(mesh)), reference::Reference(mesh, view.camera, size, function));
  const Dataset volume = grid(Association::point, false);
  expect(volume, reference::GridReference(*StateAccess::of(volume).samples, view.camera, size, function));
}

TEST(Peel, LayersOfEmissionOnlyLightMatchTheReference) {
  Settings settings = exact();
  settings.emission = Emission::independent;
  const TransferFunction function({{0, {0.1, 0.2, 0.9}, 0}, {0.4, {0.5, 0, 0}, 0}, {1, {0.2, 0.6, 0.1}, 6}});
  const scene::TetMesh mesh = tests::with_field(datasets::cube(4), waves);
  for (const Dataset& data : {Dataset::of(datasets::arrays_of(mesh)), grid(Association::point, false)})
    expect_the_reference(data, settings, view_of(ProjectionKind::perspective), function, 0.5, 4);
}

TEST(Peel, ShadedLayersMatchTheReference) {
  Settings settings = exact();
  settings.mesh.shading = settings.grid.shading = Shading{};
  const TransferFunction function = datasets::scaled(datasets::benchmark_transfer_function(), 4);
  const scene::TetMesh mesh = tests::with_field(datasets::cube(4), waves);
  for (const Dataset& data : {Dataset::of(datasets::arrays_of(mesh)), grid(Association::point, false)})
    expect_the_reference(data, settings, view_of(ProjectionKind::perspective), function, 0.5, 4);
}

TEST(Peel, SurfacesEndTheLayersThatTheyFill) {
  const scene::TetMesh mesh = tests::with_field(datasets::cube(5), waves);
  const TransferFunction function = datasets::scaled(datasets::benchmark_transfer_function(), 0.5);
  for (const double opacity : {0.3, 0.5, 1.0}) {
    Settings settings = exact();
    settings.surfaces.iso = {{0.3, glm::dvec3(1, 0.3, 0), opacity}, {0.7, {}, 0.6}};
    for (const double threshold : {0.25, 0.5, 0.9}) {
      expect_the_reference(grid(Association::point, false), settings, view_of(ProjectionKind::perspective), function,
                           threshold, 4);
      expect_the_reference(Dataset::of(datasets::arrays_of(mesh)), settings, view_of(ProjectionKind::perspective),
                           function, threshold, 4);
    }
    settings.surfaces.boundary = {{glm::dvec3(0.2, 0.9, 0.3), opacity}};
    expect_the_reference(Dataset::of(datasets::arrays_of(mesh)), settings, view_of(ProjectionKind::perspective),
                         function, 0.5, 5);
  }
}

/// Nested opaque shells: each layer shows what the shells in front of it hide.
TEST(Peel, HiddenPartsAreInLaterLayers) {
  const Dataset data = Dataset::of(datasets::arrays_of(datasets::shells(4, 3, 1)));
  const TransferFunction opaque({{0, {0.2, 0.5, 0.9}, 1e4}});
  for (Settings settings : {exact(), Settings()}) {
    settings.threads = 2;
    const RenderedFrame frame =
        Session(data, settings).render(view_of(ProjectionKind::orthographic), opaque, peeled(0.95, 64));
    for (std::size_t p = 0; p < frame.image.depth.size(); ++p)
      for (std::size_t n = 1; n < frame.layers.size(); ++n)
        if (std::isfinite(frame.layers[n].depth[p])) {
          ASSERT_LT(frame.layers[n - 1].depth[p], frame.layers[n].depth[p]);
          ASSERT_NEAR(frame.layers[n - 1].rgba[4 * p + 3], 0.95, 1e-6);
        }
    EXPECT_EQ(seen(frame.layers[0]), seen(frame.image));
    EXPECT_GT(seen(frame.layers[63]), 100u);
  }
}

TEST(Peel, ADeepPictureHasASampleALayer) {
  const scene::TetMesh mesh = tests::with_field(datasets::cube(4), waves);
  Settings settings = exact();
  settings.surfaces.iso = {{0.3, {}, 1}, {0.5, {}, 0.6}, {0.7, {}, 1}};
  const TransferFunction function = datasets::scaled(datasets::benchmark_transfer_function(), 4);
  for (const Dataset& data : {Dataset::of(datasets::arrays_of(mesh)), grid(Association::point, false)}) {
    Session session(data, settings);
    const View view = view_of(ProjectionKind::perspective);
    const RenderedFrame frame = session.render(view, function, peeled(0.6, 5, true));
    EXPECT_EQ(frame.statistics.mesh.deep_samples, frame.deep.samples.size());
    for (std::size_t p = 0; p < frame.image.depth.size(); ++p) {
      const auto samples = frame.deep.pixel(p);
      float last = -HUGE_VALF;
      bool point = false;
      for (std::size_t n = 0; n < frame.layers.size(); ++n) {
        ASSERT_EQ(n < samples.size(), std::isfinite(frame.layers[n].depth[p]));
        if (n >= samples.size()) continue;
        const DeepImageSample& s = samples[n];
        EXPECT_EQ(s.alpha, frame.layers[n].rgba[4 * p + 3]);
        EXPECT_EQ(s.green, frame.layers[n].rgba[4 * p + 1]);
        EXPECT_LE(s.z, s.z_back);
        EXPECT_TRUE(last < s.z || (last == s.z && !(point && s.z == s.z_back)));
        last = s.z_back, point = s.z == s.z_back;
      }
      const auto flat = tests::composited(samples);
      for (std::size_t c = 0; c < 4; ++c) ASSERT_NEAR(flat[c], frame.image.rgba[4 * p + c], 2e-5);
    }
    EXPECT_TRUE(session.render(view, function, peeled(0.6, 5)).deep.samples.empty());
    EXPECT_TRUE(session.render(view, function).layers.empty());
  }
}

TEST(Peel, PointsAtOneDepthAreSeparated) {
  DeepImage layers;
  layers.size = {1, 1};
  layers.begin = {0, 4};
  layers.samples = {{2, 2, 0, 0, 0, 1}, {2, 2, 0, 0, 0, 1}, {2, 2, 0, 0, 0, 1}, {2, 3, 0, 0, 0, 1}};
  frame::make_tidy(layers);
  for (std::size_t n = 1; n < 4; ++n) {
    EXPECT_LE(layers.samples[n].z, layers.samples[n].z_back);
    EXPECT_GE(layers.samples[n].z, layers.samples[n - 1].z_back);
    EXPECT_LT(layers.samples[n].z, 2.00001f);
    EXPECT_EQ(layers.samples[n].z > layers.samples[n - 1].z, n < 3);
  }
}

TEST(Peel, RanksAndThreadsChangeNoBit) {
  const scene::TetMesh mesh = tests::with_field(datasets::cube(5), waves);
  Settings settings = exact(1);
  settings.surfaces.iso = {{0.4, glm::dvec3(1, 0.3, 0), 0.5}};
  const TransferFunction function = datasets::scaled(datasets::benchmark_transfer_function(), 3);
  const View view = view_of(ProjectionKind::perspective);
  const FrameSettings how = peeled(0.7, 4, true);
  for (const bool is_grid : {false, true}) {
    const Dataset data = is_grid ? grid(Association::point, false) : Dataset::of(datasets::arrays_of(mesh));
    const RenderedFrame alone = Session(data, settings).render(view, function, how);
    const auto expect_the_same = [&](const RenderedFrame& frame) {
      ASSERT_EQ(frame.layers.size(), alone.layers.size());
      for (std::size_t n = 0; n < alone.layers.size(); ++n) {
        EXPECT_EQ(frame.layers[n].rgba, alone.layers[n].rgba) << n;
        EXPECT_EQ(frame.layers[n].depth, alone.layers[n].depth) << n;
      }
      EXPECT_EQ(frame.deep.begin, alone.deep.begin);
      EXPECT_GT(seen(frame.layers[3]), 50u);
    };
    Settings threaded = settings;
    threaded.threads = 2;
    threaded.mesh.tile_size = 7;
    expect_the_same(Session(data, threaded).render(view, function, how));
    for (const int ranks : {1, 2, 3, 4})
      run_ranks(ranks, [&](const Communicator& communicator) {
        Settings shared = settings;
        if (is_grid && ranks == 3) shared.ranks.distribution = Distribution::sort_last;
        Session session(is_grid ? data : tests::part_of(mesh, communicator), shared, communicator);
        const RenderedFrame frame = session.render(view, function, how);
        if (session.assembles())
          expect_the_same(frame);
        else
          EXPECT_TRUE(frame.layers.empty());
        // A later image without layers has none.
        EXPECT_TRUE(session.render(view, function).layers.empty());
      });
  }
}

std::string refusal(const Dataset& data, const Settings& settings, const FrameSettings& frame) {
  try {
    Session(data, settings)
        .render(view_of(ProjectionKind::orthographic), datasets::benchmark_transfer_function(), frame);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Peel, RefusesImpossibleRequests) {
  const Dataset mesh = Dataset::of(datasets::arrays_of(datasets::cube(2))), volume = grid(Association::point, false);
  for (const Dataset& data : {mesh, volume}) {
    for (const double threshold : {0.0, 1.0, -1.0, 2.0, std::nan("")})
      EXPECT_NE(refusal(data, exact(), peeled(threshold, 2)).find("`peel`"), std::string::npos) << threshold;
    for (const int layers : {0, -1, 65})
      EXPECT_NE(refusal(data, exact(), peeled(0.5, layers)).find("1 to 64"), std::string::npos) << layers;
    Settings steps = exact();
    steps.integrator.kind = IntegratorKind::sampled, steps.integrator.samples = 4;
    EXPECT_TRUE(refusal(data, steps, peeled(0.5, 2)).starts_with("`peel`"));
    Settings small = exact();
    small.memory_bytes = 1 << 20;
    EXPECT_NE(refusal(data, small, peeled(0.5, 64)).find("`memory`"), std::string::npos);
  }
  Settings scanline = exact();
  scanline.mesh.rasterizer = Rasterizer::scanline;
  EXPECT_TRUE(refusal(mesh, scanline, peeled(0.5, 2)).starts_with("`peel`"));
  Settings runs = exact();
  runs.ranks.exchange = Exchange::runs;
  for (const int ranks : {2, 3})
    EXPECT_THROW(run_ranks(ranks,
                           [&](const Communicator& communicator) {
                             Session(mesh, runs, communicator)
                                 .render(view_of(ProjectionKind::orthographic), datasets::benchmark_transfer_function(),
                                         peeled(0.5, 2));
                           }),
                 Error);
}

}  // namespace
}  // namespace tessera::peel_test
