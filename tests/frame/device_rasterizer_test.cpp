// SPDX-License-Identifier: BSD-3-Clause
// Rasterizer::device: compositors' devices rasterize the cells of their tiles.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "datasets/modify.hpp"
#include "datasets/shapes.hpp"
#include "frame/gl_job.hpp"
#include "projection/views.hpp"
#include "reference/judge.hpp"
#include "support/some_cases.hpp"

namespace tessera::frame::device_rasterizer_test {
namespace {

GlJobSetup on_device(Backend backend = Backend::osmesa) {
  GlJobSetup setup;
  setup.rasterizer = Rasterizer::device;
  setup.backends = {backend};
  setup.shared = true;
  return setup;
}

scene::TransferFunction stepped() {
  return scene::TransferFunction(
      {{0, {0.1, 0, 0.3}, 0.1}, {0.45, {0.1, 0.3, 0.9}, 0.4}, {0.45, {0.9, 0.2, 0.1}, 2}, {1, {1, 1, 1}, 0.5}});
}

/// All pixels are within the bound of `exact`, and devices rasterized most cells.
FinishedFrame expect_exact(const GlJobSetup& setup, const scene::TetMesh& mesh) {
  auto frames = rendered(setup, mesh);
  EXPECT_EQ(frames.size(), 1u);
  const reference::Reference reference(mesh, setup.camera_used(), gl_job_size, setup.function,
                                       scene::Emission::absorption);
  const auto judged = reference::judge(frames[0].image, reference, 2e-5, {}, 1);
  EXPECT_TRUE(judged.passed) << judged.max_error << " at " << judged.worst_x << "," << judged.worst_y;
  EXPECT_GT(frames[0].statistics.cells_on_device, 0u);
  EXPECT_GT(frames[0].statistics.segments, 0u);
  return std::move(frames[0]);
}

std::vector<scene::Camera> views() {
  scene::Camera cut = projection::oblique();
  cut.clipping_range = scene::ClippingRange{5.2, 6.1};
  return {projection::oblique(), projection::aligned(6, gl_job_size.height),
          projection::perspective({3.1, 2.3, 4.2}, 35), projection::perspective({0.11, 0.23, -0.17}, 100), cut};
}

class DeviceRasterizerOn : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    try {
      static_cast<void>(gl::open_context(GetParam() == Backend::egl ? gl::Platform::egl : gl::Platform::osmesa));
    } catch (const scene::Error& error) {
      GTEST_SKIP() << error.what();
    }
  }
};
INSTANTIATE_TEST_SUITE_P(All, DeviceRasterizerOn, testing::Values(Backend::osmesa, Backend::egl),
                         [](const auto& param) { return param.param == Backend::osmesa ? "OSMesa" : "EGL"; });

TEST_P(DeviceRasterizerOn, ExactIsWithinItsPromiseInEveryKindOfView) {
  test::SomeCases some(5);
  for (const auto& mesh : {datasets::cube(6, 0), datasets::cube(6)})
    for (std::size_t view = 0; view < views().size(); ++view)
      for (const auto& function : {bands(), stepped()}) {
        if (!some.next()) continue;
        SCOPED_TRACE("view " + std::to_string(view));
        GlJobSetup setup = on_device(GetParam());
        setup.view = views()[view];
        setup.function = function;
        expect_exact(setup, mesh);
      }
}

TEST_P(DeviceRasterizerOn, ExactIsWithinItsPromiseOfMeshesOfAllShapes) {
  const std::vector<std::pair<std::string, scene::TetMesh>> meshes{
      {"cell data", datasets::with_cell_data(datasets::cube(5, 0.2), 6)},
      {"annulus", datasets::annulus(16, true)},
      {"shells", datasets::shells(3, 2, 2)},
      {"graded", datasets::graded(6, 1e9)},
      {"slivers", datasets::slivers(4, 1e4)},
      {"bars", datasets::cyclic_bars(8)},
      {"thin stack", datasets::thin_stack(300, 0.3, 1)},
      {"inverted", datasets::inverted(datasets::cube(4))},
      {"tet", datasets::single_tet()}};
  test::SomeCases some(3);
  for (const auto& [name, mesh] : meshes)
    for (const bool inside : {false, true}) {
      if (!some.next()) continue;
      SCOPED_TRACE(name + (inside ? ", inside" : ""));
      GlJobSetup setup = on_device(GetParam());
      if (inside) setup.view = projection::perspective({0.6, 0.4, 0.5}, 80);
      expect_exact(setup, mesh);
    }
}

TEST(DeviceRasterizer, SegmentsMatchThoseOfPlanes) {
  TESSERA_NEEDS_OSMESA();
  for (std::size_t view = 0; view < views().size(); ++view) {
    GlJobSetup setup = on_device();
    setup.view = views()[view];
    // Nothing is opaque: otherwise the CPU skips hidden parts and does not count them.
    setup.function = scene::TransferFunction({{0, {1, 0, 0}, 0.1}, {1, {0, 1, 0}, 0.3}});
    const scene::TetMesh mesh = datasets::cube(6, 0);
    const FinishedFrame device = expect_exact(setup, mesh);
    setup.rasterizer = Rasterizer::planes;
    const FinishedFrame planes = std::move(rendered(setup, mesh)[0]);
    EXPECT_EQ(device.statistics.segments, planes.statistics.segments) << "view " << view;
    EXPECT_LT(difference(device.image, planes.image), 5e-6);
    for (std::size_t i = 0; i < planes.image.depth.size(); ++i)
      if (planes.image.depth[i] != device.image.depth[i]) {  // also for infinities
        EXPECT_NEAR(planes.image.depth[i], device.image.depth[i], 2e-6);
      }
  }
}

TEST(DeviceRasterizer, SmallBatchesGiveTheSameBits) {
  TESSERA_NEEDS_OSMESA();
  const scene::TetMesh mesh = small_cube();
  for (const bool inside : {false, true}) {
    GlJobSetup setup = on_device();
    setup.inside = inside;
    const Image at_once = rendered(setup, mesh)[0].image;
    for (const auto& [fragments, cells] : {std::pair{std::size_t{1}, std::size_t{1 << 17}}, {100, 7}, {5000, 64}}) {
      setup.gl.batch_fragments = fragments;
      setup.gl.batch_cells = cells;
      const Image again = rendered(setup, mesh)[0].image;
      EXPECT_EQ(again.rgba, at_once.rgba) << fragments << " fragments, " << cells << " cells";
      EXPECT_EQ(again.depth, at_once.depth);
    }
  }
}

TEST(DeviceRasterizer, TilesOfAnySizeAgree) {
  TESSERA_NEEDS_OSMESA();
  GlJobSetup setup = on_device();
  const Image one = rendered(setup, small_cube())[0].image;
  for (const int size : {5, 64}) {
    setup.tile_size = size;
    EXPECT_LT(difference(rendered(setup, small_cube())[0].image, one), 1e-6);  // keys are truncated to other steps
  }
}

TEST(DeviceRasterizer, RanksInAnyRolesMakeThePictureOfOne) {
  TESSERA_NEEDS_OSMESA();
  const scene::TetMesh mesh = small_cube();
  for (const bool inside : {false, true}) {
    GlJobSetup setup = on_device();
    setup.inside = inside;
    const Image one = rendered(setup, mesh)[0].image;
    for (const bool shared : {false, true})
      for (const Exchange exchange : {Exchange::segments, Exchange::runs}) {
        setup.projectors = 3;
        setup.compositors = 2;
        setup.shared = shared;
        setup.exchange = exchange;
        const FinishedFrame ranks = expect_exact(setup, mesh);
        EXPECT_LT(difference(ranks.image, one), 5e-6);
        // With the eye outside, a device produces every cell's segments, in one order whichever rank sent the cells.
        if (!inside && exchange == Exchange::segments) {
          EXPECT_EQ(ranks.image.rgba, one.rgba);
        }
      }
  }
}

TEST(DeviceRasterizer, SamplesMatchThoseOfPlanes) {
  TESSERA_NEEDS_OSMESA();
  for (const bool inside : {false, true}) {
    GlJobSetup setup = on_device();
    setup.integrator = scene::IntegratorKind::sampled;
    setup.inside = inside;
    const auto device = rendered(setup, small_cube());
    EXPECT_GT(device[0].statistics.cells_on_device, 0u);
    setup.rasterizer = Rasterizer::planes;
    EXPECT_LT(difference(device[0].image, rendered(setup, small_cube())[0].image), 5e-6);
  }
}

TEST(DeviceRasterizer, TheCpuRasterizesScenesTooThickForTheLattice) {
  TESSERA_NEEDS_OSMESA();
  const scene::TetMesh mesh = small_cube();
  GlJobSetup setup = on_device();
  // This matter is too dense for the lattice.
  setup.function = scene::TransferFunction({{0, {1, 0, 0}, 0}, {1, {0, 1, 0}, 5000}});
  const auto frames = rendered(setup, mesh);
  EXPECT_EQ(frames[0].statistics.cells_on_device, 0u);
  const reference::Reference reference(mesh, setup.camera_used(), gl_job_size, setup.function,
                                       scene::Emission::absorption);
  EXPECT_TRUE(reference::judge(frames[0].image, reference, 2e-5, {}, 1).passed);
}

TEST(DeviceRasterizer, TheCpuTakesOverWhereTheDeviceFails) {
  try {
    static_cast<void>(gl::open_context(gl::Platform::egl));  // automatic uses only EGL's devices
  } catch (const scene::Error& error) {
    GTEST_SKIP() << error.what();
  }
  for (const int after : {0, 1, 3}) {
    GlJobSetup setup = on_device(Backend::automatic);
    setup.inside = true;
    setup.gl.fault = compositor::GlFault::lost;
    setup.gl.fault_after = after;
    const FinishedFrame frame = expect_exact(setup, small_cube());
    EXPECT_NE(frame.statistics.composited_on.find("1 failed"), std::string::npos) << frame.statistics.composited_on;
  }
}

TEST(DeviceRasterizer, AutomaticUsesTheCpuForMissingDevices) {
  GlJobSetup setup = on_device(Backend::automatic);
  setup.software_will_do = false;
  const auto frames = rendered(setup, small_cube());
  if (!frames[0].statistics.composited_on.starts_with("cpu (")) GTEST_SKIP() << "there is a GPU";
  EXPECT_EQ(frames[0].statistics.cells_on_device, 0u);
  setup.rasterizer = Rasterizer::planes;
  EXPECT_EQ(frames[0].image.rgba, rendered(setup, small_cube())[0].image.rgba);
}

}  // namespace
}  // namespace tessera::frame::device_rasterizer_test
