// SPDX-License-Identifier: BSD-3-Clause
// Every kernel of volume/ under every instruction set, compared with the double-precision reference.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "reference/grid/grid_reference.hpp"
#include "reference/judge.hpp"
#include "support/instruction_sets.hpp"
#include "support/some_cases.hpp"
#include "volume/small_volume.hpp"

namespace tessera::kernels_test {
namespace {

using namespace tests;  // small volumes and views

/// Renders with every instruction set; no random pixel may have an error above `bound`, without excuses.
void expect_right(const std::string& what, const scene::SampleSource& source, const scene::TransferFunction& function,
                  volume::RenderSettings settings, double bound) {
  settings.threads = 2;
  for (const char* from : {"oblique", "from -x", "from y", "perspective"}) {
    const scene::Camera camera = view(from);
    const reference::GridReference truth(source, camera, size, function, settings.emission, settings.grid.shading);
    const auto pixels = reference::random_pixels(size, 60, 3);
    int sets = 0;
    for_each_instruction_set([&](const char* name) {
      const volume::Frame frame = volume::Renderer(source, settings).render(camera, size, function);
      const auto judged = reference::judge(frame.image, truth, bound, pixels);
      EXPECT_TRUE(judged.passed) << what << ' ' << from << ' ' << name << ": " << judged.max_error << " at "
                                 << judged.worst_x << ' ' << judged.worst_y << ", excused " << judged.excused;
      EXPECT_EQ(frame.statistics.instruction_set, name);
      EXPECT_GT(frame.statistics.samples, 0u) << what << ' ' << from << ' ' << name;
      ++sets;
    });
    EXPECT_GT(sets, 0);
  }
}

// Bounds are those promised for one process (docs/ACCURACY.md): exact 1e-5 in float32, automatic its accuracy, 1e-4 by
// default.
volume::RenderSettings by(IntegratorKind method) {
  volume::RenderSettings s;
  s.integrator.kind = method;
  return s;
}

TEST(VolumeKernels, LinesPiecesAndKnotsOfEveryTableForm) {
  // Tables of one vector, of two and of many: 7, 12 and 102 intervals.
  const Volume smooth = make_volume({37, 30, 36}, Field::smooth), noise = make_volume({21, 18, 17}, Field::noise);
  std::vector<scene::Knot> dozen;
  for (int n = 0; n < 11; ++n)
    dozen.push_back({n / 10.0, {0.5 + 0.5 * std::sin(n), 0.4, 0.1 * (10 - n)}, n % 3 == 0 ? 0.0 : 2.0 + n % 4});
  for (const Volume* v : {&smooth, &noise})
    for (const auto& function : {smooth_function(), scene::TransferFunction(dozen), many_knots()})
      expect_right(std::to_string(function.knots().size()) + " knots", *v->source, function, exact(), 1e-5);
}

TEST(VolumeKernels, CellDataBlanksShadingAndOtherLight) {
  Volume cells = make_volume({19, 17, 20}, Field::noise, true), points = make_volume({21, 18, 17}, Field::noise);
  expect_right("cell data", *cells.source, smooth_function(), exact(), 1e-5);
  volume::RenderSettings independent = exact();
  independent.emission = scene::Emission::independent;
  expect_right("independent emission", *points.source, smooth_function(), independent, 1e-5);
  volume::RenderSettings shaded = by(IntegratorKind::automatic);
  shaded.grid.shading = scene::Shading{};
  expect_right("shaded", *make_volume({37, 30, 36}, Field::smooth).source, smooth_function(), shaded, 1e-4);
  std::mt19937 random(3);
  for (Volume* v : {&cells, &points}) {
    for (int n = 0; n < 100; ++n) v->values[random() % v->values.size()] = NAN;
    v->source = scene::MemorySource::of(v->grid, v->values);
    expect_right("blanks", *v->source, smooth_function(), exact(), 1e-5);
  }
}

TEST(VolumeKernels, ErrorBoundsOfStepsAndRamps) {
  // Surfaces of a step, and flanks of a peak, in every voxel: if bounds were too small, errors would be large.
  const Volume v = make_volume({21, 18, 17}, Field::noise);
  expect_right("a step", *v.source, scene::TransferFunction({{0.5, {0.1, 0.3, 0.9}, 0}, {0.5, {1, 0.5, 0.2}, 40}}),
               exact(), 1e-5);
  expect_right("a steep peak", *v.source,
               scene::TransferFunction(
                   {{0.5, {1, 0, 0}, 0}, {0.5002, {0, 1, 0}, 300}, {0.5004, {0, 0, 1}, 0}, {1, {1, 1, 1}, 0.1}}),
               exact(), 1e-5);
}

/// The smooth field as samples of another type, 0 to `most`.
template <class T>
std::unique_ptr<scene::MemorySource> as(const Volume& v, double most) {
  scene::Grid grid = v.grid;
  grid.scale = 1 / most;
  std::vector<T> values;
  for (const float value : v.values) values.push_back(static_cast<T>(most * static_cast<double>(value)));
  return scene::MemorySource::of(grid, std::move(values));
}

TEST(VolumeKernels, SamplesOfEveryType) {
  const Volume v = make_volume({37, 30, 36}, Field::smooth);
  test::SomeCases some(3);
  const auto check = [&](const char* type, const std::unique_ptr<scene::MemorySource>& source) {
    if (!some.next()) return;
    expect_right(type, *source, smooth_function(), exact(), 1e-5);
    // Most samples are hidden: they are read in runs, not by whole rows.
    expect_right(std::string(type) + ", sharp", *source, sharp_function(), exact(), 1e-5);
  };
  check("int8", as<std::int8_t>(v, 120));
  check("uint8", as<std::uint8_t>(v, 255));
  check("int16", as<std::int16_t>(v, 30000));
  check("uint16", as<std::uint16_t>(v, 60000));
  check("int32", as<std::int32_t>(v, 1e9));
  check("uint32", as<std::uint32_t>(v, 4e9));
  check("float32", as<float>(v, 1.5));
  check("float64", as<double>(v, 1.7));
}

TEST(VolumeKernels, Steps) {
  // The method's error is far larger than that of lanes. With steps of a tenth of a voxel it is below 2e-3, which would
  // detect a wrong step.
  const Volume v = make_volume({37, 30, 36}, Field::smooth), cells = make_volume({19, 17, 20}, Field::noise, true);
  volume::RenderSettings sampled = by(IntegratorKind::sampled), table = by(IntegratorKind::preintegrated);
  sampled.grid.step = table.grid.step = 0.1;
  expect_right("sampled", *v.source, smooth_function(), sampled, 2e-3);
  expect_right("preintegrated", *v.source, smooth_function(), table, 2e-3);
  sampled.emission = scene::Emission::independent;
  expect_right("sampled, independent emission", *v.source, smooth_function(), sampled, 2e-3);
  sampled.emission = scene::Emission::absorption, sampled.grid.step = 0.01;
  expect_right("sampled, cell data", *cells.source, smooth_function(), sampled, 2e-2);
}

}  // namespace
}  // namespace tessera::kernels_test
