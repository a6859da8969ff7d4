// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "frame/gl_job.hpp"
#include "reference/judge.hpp"

namespace tessera::frame::gl_compositing_test {
namespace {

TEST(GlCompositing, ExactIsWithinItsPromiseOfTheReference) {
  TESSERA_NEEDS_OSMESA();
  const scene::TetMesh mesh = small_cube();
  for (const bool inside : {false, true})
    for (const Exchange exchange : {Exchange::segments, Exchange::runs}) {
      GlJobSetup setup;
      setup.inside = inside;
      setup.exchange = exchange;
      setup.shared = true;
      const auto frames = rendered(setup, mesh);
      ASSERT_EQ(frames.size(), 1u);
      EXPECT_NE(frames[0].statistics.composited_on.find("gl-compute (OSMesa"), std::string::npos);
      const reference::Reference reference(mesh, camera(inside), {48, 40}, bands(), scene::Emission::absorption);
      const auto judged =
          reference::judge(frames[0].image, reference, 2e-5, reference::random_pixels({48, 40}, 300, 1), 1);
      EXPECT_TRUE(judged.passed) << judged.max_error;
    }
}

TEST(GlCompositing, AnyMixOfCompositorsGivesThePictureOfTheCpu) {
  TESSERA_NEEDS_OSMESA();
  const scene::TetMesh mesh = small_cube();
  GlJobSetup setup;
  setup.projectors = setup.compositors = 2;
  setup.backends = {Backend::cpu};
  const Image cpu = rendered(setup, mesh)[0].image;
  for (const std::vector<Backend>& backends :
       {std::vector{Backend::osmesa}, {Backend::cpu, Backend::osmesa}, {Backend::osmesa, Backend::cpu}})
    for (const Exchange exchange : {Exchange::segments, Exchange::runs}) {
      setup.backends = backends;
      setup.exchange = exchange;
      const auto frames = rendered(setup, mesh);
      EXPECT_LT(difference(cpu, frames[0].image), 5e-6);  // rounding of floats
      const std::string& on = frames[0].statistics.composited_on;
      EXPECT_EQ(on.find("cpu") != std::string::npos, backends.size() == 2) << on;
    }
}

TEST(GlCompositing, FragmentShadersGiveThePictureOfTheCpusSamples) {
  TESSERA_NEEDS_OSMESA();
  const scene::TetMesh mesh = small_cube();
  for (const Rasterizer rasterizer : {Rasterizer::planes, Rasterizer::scanline}) {
    GlJobSetup setup;
    setup.integrator = scene::IntegratorKind::sampled;
    setup.rasterizer = rasterizer;
    setup.projectors = 2;
    setup.backends = {Backend::cpu};
    const Image cpu = rendered(setup, mesh)[0].image;
    setup.backends = {Backend::osmesa};
    setup.gl.method = compositor::GlMethod::fragment;
    setup.gl.half = false;
    EXPECT_LT(difference(cpu, rendered(setup, mesh)[0].image), 1e-4);
    setup.gl.half = true;
    // About 20 blends of values around one, each rounded to half precision with an error of 2^-12.
    EXPECT_LT(difference(cpu, rendered(setup, mesh)[0].image), 20 * 0x1p-12);
  }
}

TEST(GlCompositing, FramesFollowOneAnother) {
  TESSERA_NEEDS_OSMESA();
  GlJobSetup setup;
  setup.frames = 3;
  const auto frames = rendered(setup, small_cube());
  ASSERT_EQ(frames.size(), 3u);
  // Fragments are distributed differently over batches; the result does not change.
  EXPECT_EQ(frames[0].image.rgba, frames[1].image.rgba);
  EXPECT_EQ(frames[0].image.rgba, frames[2].image.rgba);
}

/// The only error of a job.
scene::Error error_of(const GlJobSetup& setup) {
  try {
    rendered(setup, small_cube());
  } catch (const scene::Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return scene::bad_input("");
}

TEST(GlCompositing, ADeviceThatFailsDuringTheRunEndsTheJobOnAllRanks) {
  TESSERA_NEEDS_OSMESA();
  for (const auto fault : {compositor::GlFault::lost, compositor::GlFault::memory}) {
    GlJobSetup setup;
    setup.projectors = setup.compositors = 2;
    setup.gl.fault = fault;
    setup.gl.fault_after = 1;
    setup.frames = 3;
    const scene::Error error = error_of(setup);
    EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
    EXPECT_NE(std::string(error.what()).find("OSMesa, "), std::string::npos) << error.what();
  }
}

TEST(GlCompositing, BackendsMustBeOneOrOneForEachCompositor) {
  GlJobSetup setup;
  setup.compositors = 3;
  setup.backends = {Backend::cpu, Backend::osmesa};
  EXPECT_EQ(error_of(setup).code(), scene::ErrorCode::bad_input);
}

TEST(GlCompositing, AutomaticFallsBackToTheCpuAndReportsIt) {
  try {
    static_cast<void>(gl::open_context(gl::Platform::egl));
  } catch (const scene::Error& error) {
    GTEST_SKIP() << error.what();
  }
  const scene::TetMesh mesh = small_cube();
  GlJobSetup setup;
  setup.backends = {Backend::cpu};
  const Image cpu = rendered(setup, mesh)[0].image;
  setup.backends = {Backend::automatic};
  setup.gl.fault = compositor::GlFault::lost;
  // Three frames give at least 3 batches: a batch has tiles of one frame only. The number of batches depends on timing.
  setup.frames = 3;
  for (const int after : {0, 2}) {
    setup.gl.fault_after = after;
    const auto frames = rendered(setup, mesh);
    ASSERT_EQ(frames.size(), 3u);
    for (const FinishedFrame& frame : frames) EXPECT_LT(difference(cpu, frame.image), 5e-6);
    const std::string& on = frames[2].statistics.composited_on;
    EXPECT_NE(on.find("1 failed"), std::string::npos) << on;
  }
}

}  // namespace
}  // namespace tessera::frame::gl_compositing_test
