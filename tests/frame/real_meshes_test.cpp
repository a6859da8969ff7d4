// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "datasets/transfer_functions.hpp"
#include "frame/mesh/render.hpp"
#include "frame/shared_meshes.hpp"
#include "reference/judge.hpp"
#include "support/read_files.hpp"

/// The promise of accuracy_test.cpp on external meshes: curvilinear grids with seams and boundary layers, machine
/// parts, an oil reservoir with faults at coordinates of 7e6.
namespace tessera::frame::real_meshes_test {
namespace {

using scene::TransferFunction;

constexpr scene::ImageSize size{120, 90};

class RealMesh : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_mesh(GetParam()); !missing.empty()) GTEST_SKIP() << missing;
    mesh = io::read_mesh(shared_mesh(GetParam())).mesh;
    const scene::Box box = scene::bounds(mesh);
    diagonal = glm::length(box.high - box.low);
    scene::Camera outside = scene::frame_box(box, size);
    cameras.push_back(outside);
    outside.projection = scene::ProjectionKind::perspective;
    outside.view_angle = 35;
    cameras.push_back(outside);
    scene::Camera inside = outside;
    inside.position = box.low + (box.high - box.low) * glm::dvec3(0.51, 0.47, 0.53);
    inside.focal_point = inside.position + glm::dvec3(1, 0.3, 0.2) * diagonal;
    inside.view_angle = 80;
    cameras.push_back(inside);
  }

  static Settings exact() {
    Settings settings;
    settings.integrator.kind = scene::IntegratorKind::exact;
    return settings;
  }

  scene::TetMesh mesh;
  double diagonal = 0;
  std::vector<scene::Camera> cameras;
};

INSTANTIATE_TEST_SUITE_P(SharedData, RealMesh, shared_meshes());

TEST_P(RealMesh, ExactIsWithinItsPromise) {
  Renderer renderer(mesh, exact());
  const auto range = scene::scalar_range(mesh);
  const auto pixels = reference::random_pixels(size, 150, 5);
  for (std::size_t v = 0; v < cameras.size(); ++v)
    for (const double extinction : {3.0, 3000.0}) {
      // Thin and smooth, thick and stepped.
      const TransferFunction function = extinction < 100 ? datasets::smooth_knots(40, range, extinction / diagonal, 3)
                                                         : datasets::step_knots(20, range, extinction / diagonal, 3);
      const scene::Image image = renderer.render(cameras[v], size, function);
      const auto judged = reference::judge(image, reference::Reference(mesh, cameras[v], size, function), 2e-5, pixels);
      EXPECT_TRUE(judged.passed) << "view " << v << ", extinction " << extinction << ": max " << judged.max_error
                                 << " at " << judged.worst_x << ',' << judged.worst_y;
    }
}

TEST_P(RealMesh, RaysHitWhereTheReferencesDoAndAreAsLong) {
  const double extinction = 0.5 / diagonal;
  const TransferFunction haze({{0, {1, 1, 1}, extinction}});
  Renderer renderer(mesh, exact());
  const auto pixels = reference::random_pixels(size, 300, 6);
  for (const scene::Camera& camera : cameras) {
    const scene::Image image = renderer.render(camera, size, haze);
    const auto truth = reference::Reference(mesh, camera, size, haze).pixels(pixels);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const std::size_t at = image.index(pixels[i].x, pixels[i].y);
      ASSERT_EQ(std::isinf(image.depth[at]), truth[i].segments == 0) << pixels[i].x << ',' << pixels[i].y;
      ASSERT_NEAR(-std::log1p(-image.rgba[4 * at + 3]) / extinction, truth[i].length, 1e-5 * diagonal);
    }
  }
}

}  // namespace
}  // namespace tessera::frame::real_meshes_test
