// SPDX-License-Identifier: BSD-3-Clause
// Transfer functions so steep, and matter so dense, that rounding in float lanes is visible: compares every pixel with
// the double-precision reference of reference/, which shares no code with casters.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "reference/grid/grid_reference.hpp"
#include "reference/judge.hpp"
#include "scene/camera.hpp"
#include "scene/sample_source.hpp"
#include "volume/render.hpp"

namespace tessera::steep_function_test {
namespace {

constexpr scene::ImageSize size{40, 40};

using Field = std::function<double(double, double, double)>;  // of (i, j, k)

std::unique_ptr<scene::MemorySource> volume_of(scene::GridIndex points, const Field& field,
                                               scene::Association association = scene::Association::point) {
  scene::Grid grid;
  grid.geometry.points = points;
  grid.geometry.association = association;
  const scene::GridIndex samples = grid.geometry.samples();
  std::vector<float> values;
  for (std::int64_t k = 0; k < samples[2]; ++k)
    for (std::int64_t j = 0; j < samples[1]; ++j)
      for (std::int64_t i = 0; i < samples[0]; ++i)
        values.push_back(static_cast<float>(field(double(i), double(j), double(k))));
  return scene::MemorySource::of(grid, std::move(values));
}

Field noise() {
  return [random = std::mt19937(5)](double, double, double) mutable {
    return std::uniform_real_distribution<double>(0, 1)(random);
  };
}

/// A camera that looks at the volume's middle from `direction` times `away` (in voxels).
scene::Camera camera_of(const scene::SampleSource& source, double away,
                        const glm::dvec3& direction = glm::dvec3(1, 0.7, 1.9)) {
  const scene::Box box = scene::bounds(source.geometry());
  scene::Camera camera = scene::frame_box(box, size);
  camera.focal_point = (box.low + box.high) * 0.5;
  camera.position = camera.focal_point + away * direction;
  camera.view_up = {0, 0, 1};
  return camera;
}

struct Outcome {
  double error;             ///< relative to the promised one
  std::uint64_t in_double;  ///< pixels
};

/// The worst outcome of `exact`, and of `auto` with accuracies of 1e-5 and 1e-4; no pixel is excused.
Outcome outcome_of(const scene::SampleSource& source, const scene::Camera& camera,
                   const scene::TransferFunction& function, scene::Emission emission = scene::Emission::absorption) {
  const reference::GridReference truth(source, camera, size, function, emission);
  std::vector<reference::PixelIndex> pixels;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) pixels.push_back({x, y});
  Outcome worst{0, 0};
  for (const double accuracy : {0.0, 1e-5, 1e-4}) {
    volume::RenderSettings settings;
    settings.emission = emission;
    settings.threads = 2;
    if (accuracy == 0)
      settings.integrator.kind = IntegratorKind::exact;
    else
      settings.integrator.accuracy = accuracy;
    const double bound = accuracy == 0 ? 1e-5 : accuracy;
    const volume::Frame frame = volume::Renderer(source, settings).render(camera, size, function);
    const auto judgement = reference::judge(frame.image, truth, bound, pixels, 2);
    EXPECT_EQ(judgement.excused, 0u);
    worst.error = std::max(worst.error, judgement.max_error_not_excused / bound);
    worst.in_double = std::max(worst.in_double, frame.statistics.pixels_again);
  }
  return worst;
}

/// Knots are rounded like samples. If a peak is a three-thousandth of the range wide, its optical depth has a relative
/// error of 1e-4 at every crossing; errors seen through it were once weighted by its transmittance.
TEST(SteepFunction, APeaksRoundedKnotsAreNotTakenForItsOwn) {
  const auto source = volume_of({3, 3, 5}, [](double i, double j, double k) {
    return 0.0014568 - 0.00072842 * i + 0.00299022 * (j * 0.28 + k * 0.54);
  });
  const double low = -0.01, at = 0.0049024151985, high = 0.02;
  for (const double extinction : {300.0, 1500.0, 6559.7}) {
    const scene::TransferFunction function({{low, {0.8, 0.2, 0.8}, 0.002},
                                            {at - 3.5163e-6, {0.4, 0.55, 0.57}, 0.002},
                                            {at, {0.7, 0.25, 0.85}, extinction},
                                            {at + 2.0738e-6, {0.83, 0.01, 0.39}, 0.002},
                                            {high, {0.8, 0.7, 0.4}, 0.002}});
    const Outcome outcome = outcome_of(*source, camera_of(*source, 4), function);
    EXPECT_LE(outcome.error, 1) << extinction;
    EXPECT_GT(outcome.in_double, 0u) << extinction;
  }
}

/// Rays that begin in dense matter, at a near plane or a side of the volume, begin at a rounded position.
TEST(SteepFunction, RaysThatBeginInDenseMatterBeginWhereTheyDo) {
  const auto source = volume_of({8, 31, 9}, noise());
  scene::Camera camera = camera_of(*source, 20, glm::dvec3(0.31, -1.9, 0.43));
  camera.parallel_scale = 5;
  camera.clipping_range = scene::ClippingRange{50, 80};  // ten voxels behind the middle
  std::mt19937 random(9);
  std::uniform_real_distribution<double> any(0, 1);
  for (const double extinction : {100.0, 1e5}) {
    std::vector<scene::Knot> knots;
    for (int n = 0; n <= 400; ++n)
      knots.push_back({n / 400.0, {any(random), any(random), any(random)}, extinction * any(random)});
    const Outcome outcome = outcome_of(*source, camera, scene::TransferFunction(std::move(knots)));
    EXPECT_LE(outcome.error, 1) << extinction;
  }
}

/// A ray crosses steps and ramps in one voxel, the last of them dark: the front of a peak hides errors of its back.
TEST(SteepFunction, ErrorsInFrontOfDenseMatterAreSeen) {
  const auto source = volume_of({8, 8, 8}, noise());
  for (const double extinction : {50.0, 2e3, 1e5}) {
    const scene::TransferFunction function({{0, {0.1, 0.9, 0.3}, 0},
                                            {0.4137, {0.1, 0.9, 0.3}, 0},
                                            {0.4137, {0.9, 0.1, 0.3}, extinction},
                                            {0.4139, {0.1, 0.2, 0.9}, 0.7 * extinction},
                                            {0.4139, {0.1, 0.2, 0.9}, 0},
                                            {0.7, {0.3, 0.6, 0.1}, 0},
                                            {0.7003, {0.1, 0.6, 0.9}, extinction},
                                            {0.7004, {0.9, 0.6, 0.1}, extinction},
                                            {1, {0.9, 0.6, 0.1}, 0}});
    EXPECT_LE(outcome_of(*source, camera_of(*source, 8), function).error, 1) << extinction;
  }
}

/// The length of a ray that cuts a corner of a dense voxel is the difference of two rounded positions.
TEST(SteepFunction, CornersOfDenseCellsAreAsLongAsTheyAre) {
  const auto source = volume_of({12, 33, 11}, noise(), scene::Association::cell);
  scene::Camera camera = camera_of(*source, 20, glm::dvec3(0.31, -1.9, 0.43));
  camera.parallel_scale = 7;
  for (const double extinction : {100.0, 1e3, 1e4}) {
    const scene::TransferFunction function({{0, {0.1, 0.9, 0.3}, 0},
                                            {0.93, {0.1, 0.9, 0.3}, 0},
                                            {0.96, {0.9, 0.1, 0.3}, extinction},
                                            {1, {0.1, 0.3, 0.9}, 0}});
    EXPECT_LE(outcome_of(*source, camera, function).error, 1) << extinction;
  }
}

/// Matter of one colour that hides everything behind needs no second cast, however dense it is.
TEST(SteepFunction, SurfacesOfOneColourStayInFloatLanes) {
  const auto source = volume_of(
      {24, 24, 24}, [](double i, double j, double k) { return std::hypot(i - 11.3, j - 11.9, k - 11.6) / 12; });
  const scene::TransferFunction function(
      {{0, {1, 0.8, 0.5}, 60}, {0.7, {1, 0.8, 0.5}, 60}, {0.7, {1, 0.8, 0.5}, 0}, {1, {1, 0.8, 0.5}, 0}});
  const Outcome outcome = outcome_of(*source, camera_of(*source, 15), function);
  EXPECT_LE(outcome.error, 1);
  EXPECT_LT(outcome.in_double, 160u);  // a tenth of the pixels
}

}  // namespace
}  // namespace tessera::steep_function_test
