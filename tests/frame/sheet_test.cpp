// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "api/random_cases.hpp"
#include "datasets/boxes.hpp"
#include "frame/mesh/render.hpp"
#include "reference/judge.hpp"

/// Thin dense sheets. A ray's path in a sheet is a hundred-thousandth of the depth range of the sheet's faces.
namespace tessera::frame::sheet_test {
namespace {

struct Sheet {
  double thickness, length, ahead, beside, view_angle, extinction;
};

class Sheets : public testing::TestWithParam<Sheet> {};
INSTANTIATE_TEST_SUITE_P(Frame, Sheets,
                         testing::Values(Sheet{3e-4, 2, 0.12, 1.73, 140, 300}, Sheet{5e-4, 2.5, 0.105, 2.02, 125, 77},
                                         Sheet{7e-4, 2, 0.24, 0.42, 149, 520}, Sheet{2.5e-4, 1, 0.057, 0.93, 147, 87},
                                         Sheet{1.1e-3, 3.1, 0.042, 1.2, 131, 87},
                                         Sheet{6e-3, 2.2, 0.24, 3.1, 115, 220}));

/// The eye is next to a sheet and looks along it, so that the sheet's length is in the direction of depth. Rays at the
/// window's edge cross the sheet's thickness.
TEST_P(Sheets, KeepTheirThicknessUnderWidePerspective) {
  const Sheet sheet = GetParam();
  scene::TetMesh mesh = datasets::regular_split(2, 1, 2, {2, sheet.thickness, sheet.length / 2},
                                                {-2, -sheet.thickness, -sheet.ahead - sheet.length});
  scene::Camera camera;
  camera.position = {0.031, sheet.beside, 0};
  camera.focal_point = {0.031, sheet.beside, -1};
  camera.projection = scene::ProjectionKind::perspective;
  camera.view_angle = sheet.view_angle;
  constexpr scene::ImageSize size{40, 40};
  const auto [low, high] = scene::scalar_range(mesh);
  const scene::TransferFunction function(
      {{low, {0.2, 0.4, 0.9}, sheet.extinction}, {high, {0.9, 0.5, 0.2}, 0.7 * sheet.extinction}});
  for (const double bound : {2e-5, 1e-5}) {
    Settings settings;
    settings.integrator.kind = bound == 2e-5 ? scene::IntegratorKind::exact : scene::IntegratorKind::automatic;
    settings.integrator.accuracy = bound;
    const scene::Image image = Renderer(mesh, settings).render(camera, size, function);
    const reference::Reference reference(mesh, camera, size, function);
    const reference::Judgement judgement = reference::judge(image, reference, bound);
    EXPECT_LE(judgement.max_error_not_excused, bound) << judgement.over_bound << " over";
  }
}

/// A sheet or a stack of them, thickness 1e-7 to 1 of its width; half of them seen lengthwise with a wide angle.
RandomCase random_sheet(Random& random) {
  const bool lengthwise = random.chance(0.5);
  const double thickness = lengthwise ? random.power(-6, -1) : random.power(-7, 0);
  constexpr int numbers_of_layers[] = {1, 1, 1, 2, 5, 30};
  const int layers = random.of(numbers_of_layers), side = 1 + random.below(4);
  const double ahead = random.power(-1.5, 0.3), length = random.uniform(1, 4);
  RandomCase c{};
  c.mesh = lengthwise
               ? datasets::regular_split(side, layers, side, {4.0 / side, thickness / layers, length / side},
                                         {-2, -thickness, -ahead - length})
               : datasets::regular_split(side, layers, side, {2.0 / side, thickness / layers, 2.0 / side}, {-1, 0, -1});
  const int pattern = random.below(4);
  for (std::size_t v = 0; v < c.mesh.scalars.size(); ++v)
    c.mesh.scalars[v] = pattern == 0   ? 0.6
                        : pattern == 1 ? random.uniform(0, 1)
                        : pattern == 2 ? static_cast<double>(v % 2)
                                       : 0.5 + 0.1 * c.mesh.positions[v].x;
  const double dense = lengthwise ? random.power(1, 3) : random.power(0, 6);
  std::vector<scene::Knot> knots{{0, {0.3, 0.2, 0.9}, random.chance(0.5) ? 0 : 0.3 * dense},
                                 {0.5, {0.1, 0.7, 0.3}, dense * random.uniform(0, 1)}};
  if (random.chance(0.3)) knots.push_back({0.5, {0.8, 0.8, 0.1}, random.chance(0.5) ? 0 : dense});
  knots.push_back({1, {0.9, 0.5, 0.4}, dense});
  c.function = scene::TransferFunction(knots);
  c.camera.projection = scene::ProjectionKind::perspective;
  if (lengthwise) {
    c.camera.position = {random.uniform(-0.3, 0.3), random.power(-1.5, 0.6), 0};
    c.camera.focal_point = {0, c.camera.position.y - (random.chance(0.3) ? random.uniform(-1, 1) : 0), -1};
    c.camera.view_angle = random.uniform(90, 174);
  } else {
    const glm::dvec3 at(random.uniform(-0.9, 0.9), thickness * random.uniform(0, 1), random.uniform(-0.9, 0.9));
    c.camera.position = at + random.direction() * random.power(-2, 1);
    c.camera.focal_point = random.chance(0.7) ? at : c.camera.position + random.direction();
    c.camera.view_angle = random.uniform(5, 175);
    if (random.chance(0.3)) c.camera.projection = scene::ProjectionKind::orthographic;
    c.camera.parallel_scale = random.power(-1.5, 0.3);
  }
  const glm::dvec3 forward = glm::normalize(c.camera.focal_point - c.camera.position);
  c.camera.view_up = std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  c.words = std::to_string(layers) + " layers, " + std::to_string(std::log10(thickness)) +
            " log thickness, extinction " + std::to_string(dense) + (lengthwise ? ", lengthwise" : "") + ", angle " +
            std::to_string(c.camera.view_angle);
  return c;
}

TEST(Sheet, RandomSheetsKeepThePromise) { expect_random_cases_right(5, 100, random_sheet); }

}  // namespace
}  // namespace tessera::frame::sheet_test
