// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "datasets/shapes.hpp"
#include "datasets/transfer_functions.hpp"
#include "frame/mesh/render.hpp"
#include "reference/judge.hpp"
#include "support/some_cases.hpp"

/// The promise of the `exact` integrator: at most 2e-5 from the reference in linear RGBA, whatever the mesh, the view
/// and the transfer function. (docs/ACCURACY.md: how error is judged.)
namespace tessera::frame::accuracy_test {
namespace {

using scene::Camera;
using scene::ImageSize;
using scene::ProjectionKind;
using scene::TransferFunction;

constexpr double promised_error = 2e-5;
constexpr ImageSize size{48, 32};

struct NamedMesh {
  const char* name;
  scene::TetMesh (*make)();
};

/// All are within [-1, 1]^3 or slightly more, with scalars in [0, 1].
const NamedMesh meshes[] = {
    {"cube", [] { return datasets::cube(8, 0.2); }},
    {"cube_cells", [] { return datasets::with_cell_data(datasets::cube(8, 0.2), 6); }},
    {"regular", [] { return datasets::regular_split(8, 8, 8, glm::dvec3(0.25), glm::dvec3(-1)); }},
    {"regular_cells",
     [] { return datasets::with_cell_data(datasets::regular_split(8, 8, 8, glm::dvec3(0.25), glm::dvec3(-1))); }},
    {"graded", [] { return datasets::graded(8, 1e8); }},
    {"slivers", [] { return datasets::slivers(6, 1e5); }},
    {"annulus_with_seam", [] { return datasets::annulus(24, true); }},
    {"shells_cells", [] { return datasets::with_cell_data(datasets::shells(4, 2, 2)); }},
    {"cyclic_bars", [] { return datasets::cyclic_bars(8); }},
    {"mixed_orientation",
     [] { return datasets::inverted(datasets::ball(2), datasets::Orientation::every_other_inverted); }},
};

struct NamedView {
  const char* name;
  Camera camera;
};

Camera view(ProjectionKind kind, double scale_or_angle, const glm::dvec3& from, const glm::dvec3& at) {
  Camera camera;
  camera.position = from;
  camera.focal_point = at;
  camera.projection = kind;
  (kind == ProjectionKind::orthographic ? camera.parallel_scale : camera.view_angle) = scale_or_angle;
  return camera;
}

std::vector<NamedView> views() {
  const auto orthographic = ProjectionKind::orthographic, perspective = ProjectionKind::perspective;
  std::vector<NamedView> all{
      {"orthographic", view(orthographic, 1.7, {3.1, 2.3, 4.2}, {0, 0, 0})},
      // Vertices of the regular split are on the centres of every fourth pixel.
      {"along an axis", view(orthographic, 1, {1 / 32., 1 / 32., 5}, {1 / 32., 1 / 32., 0})},
      {"perspective", view(perspective, 30, {-2.1, 2.3, 5.2}, {0, 0, 0})},
      {"eye inside", view(perspective, 80, {0.61, -0.13, 0.07}, {-1, 0.4, -0.3})},
      {"eye inside, wide", view(perspective, 150, {-0.57, 0.31, 0.11}, {1, 0.1, -0.2})},
      {"orthographic from inside", view(orthographic, 1.1, {0.13, 0.06, 0.02}, {-1, 0.3, 0.9})},
      {"near and far planes", view(perspective, 40, {2.1, 1.3, 2.2}, {0, 0, 0})},
  };
  all.back().camera.clipping_range = scene::ClippingRange{2.7, 3.6};
  return all;
}

struct NamedFunction {
  const char* name;
  TransferFunction function;
};

std::vector<NamedFunction> functions() {
  return {
      {"2 knots", datasets::smooth_knots(2)},   {"6 knots", datasets::benchmark_transfer_function()},
      {"17 knots", datasets::smooth_knots(17)}, {"300 knots", datasets::smooth_knots(300)},
      {"1 step", datasets::step_knots(1)},      {"7 steps", datasets::step_knots(7)},
      {"150 steps", datasets::step_knots(150)},
  };
}

/// The eye exactly on the surface of cells of the regular split.
std::vector<NamedView> views_from_surfaces() {
  const auto from = [](const glm::dvec3& eye) { return view(ProjectionKind::perspective, 100, eye, {0.9, -0.3, 0.6}); };
  return {{"eye on a vertex", from({0, 0.25, -0.5})},
          {"eye on an edge", from({0.125, 0.125, 0.125})},
          {"eye in a face", from({0.125, 0.0625, 0})},
          {"eye on the mesh's corner", view(ProjectionKind::perspective, 80, {-1, -1, -1}, {1, 0.9, 0.8})}};
}

class Accuracy : public testing::TestWithParam<NamedMesh> {};

INSTANTIATE_TEST_SUITE_P(Meshes, Accuracy, testing::ValuesIn(meshes),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(Accuracy, ExactKeepsItsPromise) {
  const scene::TetMesh mesh = GetParam().make();
  std::size_t n = 0;
  test::SomeCases some(5);
  for (const NamedView& v : views())
    for (const NamedFunction& f : functions()) {
      if (!some.next()) continue;
      // The optical depth through the mesh is that of haze, of usual matter, or of matter that is opaque within a
      // ten-thousandth of the path. Consecutive functions and views get different values. All pairs of a view and a
      // thickness, and of a function and a thickness, occur.
      const double thickness = std::array{0.002, 1.0, 1000.0}[n % 3];
      const Emission emission = n % 4 == 3 ? Emission::independent : Emission::absorption;
      ++n;
      Settings settings;
      settings.integrator.kind = scene::IntegratorKind::exact;
      settings.emission = emission;
      const TransferFunction function = datasets::scaled(f.function, thickness);
      const scene::Image image = Renderer(mesh, settings).render(v.camera, size, function);
      const reference::Reference reference(mesh, v.camera, size, function, emission);
      const reference::Judgement judgement = reference::judge(image, reference, promised_error);
      const auto& [r, g, b, a] = judgement.worst_reference;
      EXPECT_TRUE(judgement.passed) << v.name << ", " << f.name << " x " << thickness
                                    << (emission == Emission::independent ? ", independent" : "") << ": max "
                                    << judgement.max_error << " at (" << judgement.worst_x << ", " << judgement.worst_y
                                    << "), over " << judgement.over_bound << ", excused " << judgement.excused
                                    << "; found " << testing::PrintToString(judgement.worst_value) << ", true " << r
                                    << ' ' << g << ' ' << b << ' ' << a;
    }
}

TEST_P(Accuracy, RaysMatchTheReferencesHitsAndLengths) {
  const scene::TetMesh mesh = GetParam().make();
  const double extinction = 0.25, diagonal = 3.4;
  const TransferFunction haze({{0, {1, 1, 1}, extinction}});
  Settings settings;
  settings.integrator.kind = scene::IntegratorKind::exact;
  for (const NamedView& v : views()) {
    const scene::Image image = Renderer(mesh, settings).render(v.camera, size, haze);
    const std::vector<reference::Pixel> truth = reference::Reference(mesh, v.camera, size, haze).image();
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double length = -std::log1p(-image.rgba[4 * i + 3]) / extinction;
      ASSERT_EQ(std::isinf(image.depth[i]), std::isinf(truth[i].z)) << v.name << " pixel " << i;
      ASSERT_NEAR(length, truth[i].length, 1e-5 * diagonal) << v.name << " pixel " << i;
      if (std::isfinite(truth[i].z)) {
        ASSERT_NEAR(image.depth[i], truth[i].z, 1e-6 * diagonal) << v.name << " pixel " << i;
      }
    }
  }
}

TEST(AccuracyOfLanes, UncertainRaysAreRenderedInDoublePrecision) {
  const scene::TetMesh mesh = datasets::cube(6, 0.2);
  const Camera camera = view(ProjectionKind::orthographic, 1.4, {2.2, 1.4, 3}, {0, 0, 0});
  const auto expect_kept = [&](double accuracy, const TransferFunction& function, Emission emission,
                               const Surfaces& surfaces) {
    Settings settings;
    settings.integrator.accuracy = accuracy;
    settings.emission = emission;
    settings.surfaces = surfaces;
    FrameStatistics statistics;
    const auto image = Renderer(mesh, settings).render(camera, size, function, &statistics);
    EXPECT_FALSE(statistics.on_lattice) << accuracy;
    const reference::Reference truth(mesh, camera, size, function, emission, surfaces);
    EXPECT_LE(reference::judge(image, truth, accuracy).max_error_not_excused, accuracy) << accuracy;
  };
  const TransferFunction ramp({{0, {0.1, 0.2, 0.9}, 0.2}, {1, {1, 0.6, 0.1}, 3}});
  Surfaces surface;
  surface.iso = {{0.505, glm::dvec3(1, 0, 0), 0.4}};
  for (const double accuracy : {1e-6, 3e-6}) {
    expect_kept(accuracy, ramp, Emission::absorption, {});
    expect_kept(accuracy, ramp, Emission::absorption, surface);
  }
  // Light of magnitude in the hundreds, which lanes reproduce to 5e-7.
  const TransferFunction bright({{0, {20, 40, 180}, 0.2}, {1, {200, 120, 20}, 0.3}});
  expect_kept(1e-4, bright, Emission::independent, {});
}

TEST(AccuracyAtSurfaces, AnEyeExactlyOnAVertexEdgeOrFaceSeesAllCells) {
  Settings settings;
  settings.integrator.kind = scene::IntegratorKind::exact;
  const TransferFunction function = datasets::scaled(datasets::benchmark_transfer_function(), 2);
  for (const bool jittered : {false, true}) {
    scene::TetMesh mesh = datasets::regular_split(8, 8, 8, glm::dvec3(0.25), glm::dvec3(-1));
    std::vector<NamedView> all = views_from_surfaces();
    if (jittered) {
      mesh = datasets::cube(8, 0.2);
      all = {{"eye on an oblique vertex", view(ProjectionKind::perspective, 100, mesh.positions[364], {2, 1, 0.3})}};
    }
    for (const NamedView& v : all) {
      const scene::Image image = Renderer(mesh, settings).render(v.camera, size, function);
      const reference::Reference reference(mesh, v.camera, size, function);
      const reference::Judgement judgement = reference::judge(image, reference, promised_error);
      EXPECT_TRUE(judgement.passed) << v.name << ": max " << judgement.max_error << ", over " << judgement.over_bound;
    }
  }
}

}  // namespace
}  // namespace tessera::frame::accuracy_test
