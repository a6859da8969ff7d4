// SPDX-License-Identifier: BSD-3-Clause
// Which instruction set serves a frame, and that sets without lanes never serve the lattice.
#include "frame/mesh/lattice_frame.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>

#include "datasets/boxes.hpp"
#include "frame/image_difference.hpp"
#include "frame/mesh/render.hpp"
#include "reference/judge.hpp"
#include "reference/reference.hpp"
#include "support/instruction_sets.hpp"

namespace tessera::frame::lattice_frame_test {
namespace {

constexpr scene::ImageSize size{40, 30};

scene::Camera camera() {
  scene::Camera camera;
  camera.position = {2.9, 2.1, 4.3};
  camera.parallel_scale = 1.5;
  return camera;
}

scene::TransferFunction function() {
  return scene::TransferFunction({{0, {0.1, 0.2, 0.9}, 0}, {0.5, {0.3, 0.9, 0.2}, 2}, {1, {0.9, 0.3, 0.1}, 5}});
}

scene::Image rendered(const scene::TetMesh& mesh, bool lattice, FrameStatistics& statistics) {
  Settings settings;
  settings.integrator.kind = scene::IntegratorKind::exact;
  settings.use.lattice = lattice;
  return Renderer(mesh, settings).render(camera(), size, function(), &statistics);
}

TEST(LatticeFrame, IsServedByEveryInstructionSetWithLanesAndByTheOneThatWasChosen) {
  const scene::TetMesh mesh = datasets::cube(4);
  std::set<std::string> served;
  tests::for_each_instruction_set([&](const char* name) {
    FrameStatistics statistics;
    rendered(mesh, true, statistics);
    EXPECT_TRUE(statistics.on_lattice) << name;
    EXPECT_EQ(statistics.instruction_set, name);
    served.insert(statistics.instruction_set);
  });
  // Every supported machine has at least SSE4.
  EXPECT_FALSE(served.empty());
}

// The lattice changes depths and scalars by less than 1e-8; what the methods add to that is float rounding.
TEST(LatticeFrame, SamplingMethodsGiveTheImageOfDoublePrecision) {
  const scene::TetMesh mesh = datasets::cube(5, 0.2);
  for (const auto kind :
       {scene::IntegratorKind::sampled, scene::IntegratorKind::preintegrated, scene::IntegratorKind::partial})
    for (const bool shaded : {false, true})
      for (const Emission emission : {Emission::absorption, Emission::independent}) {
        if (emission == Emission::independent && (shaded || kind == scene::IntegratorKind::partial)) continue;
        Settings settings;
        settings.integrator = {.kind = kind, .samples = 5, .table_size = 32};
        settings.emission = emission;
        if (shaded) settings.mesh.shading.emplace();
        const auto render = [&](bool lattice, const scene::TransferFunction& of) {
          settings.use.lattice = lattice;
          FrameStatistics statistics;
          const scene::Image image = Renderer(mesh, settings).render(camera(), size, of, &statistics);
          return std::pair(image, statistics.on_lattice);
        };
        const auto [image, on_lattice] = render(true, function());
        const auto [in_double, never] = render(false, function());
        EXPECT_TRUE(on_lattice);
        EXPECT_FALSE(never);
        EXPECT_GT(difference(image, scene::Image(size)), 0.1);
        EXPECT_LT(difference(image, in_double), 2e-6) << static_cast<int>(kind) << shaded;
        const scene::TransferFunction step({{0.2, {1, 1, 0}, 1}, {0.5, {0, 1, 1}, 1}, {0.5, {1, 0, 0}, 3}});
        EXPECT_FALSE(render(true, step).second);
      }
}

TEST(LatticeFrame, OnEmulatedLanesAFrameUsesDoublesWithTheSamePromise) {
  const scene::TetMesh mesh = datasets::cube(4);
  const reference::Reference reference(mesh, camera(), size, function());
  int targets = 0;
  tests::for_each_target(tests::emulated_targets, [&](const char* name) {
    SCOPED_TRACE(name);
    ++targets;
    FrameStatistics statistics, in_double;
    const scene::Image image = rendered(mesh, true, statistics);
    EXPECT_EQ(statistics.instruction_set, name);
    EXPECT_FALSE(statistics.on_lattice);
    EXPECT_EQ(image.rgba, rendered(mesh, false, in_double).rgba);
    EXPECT_LE(reference::judge(image, reference, 2e-5).max_error, 2e-5);  // the promise of `exact`
  });
  EXPECT_EQ(targets, (HWY_TARGETS & tests::emulated_targets) != 0 ? 1 : 0);  // a build has at most one fallback
}

}  // namespace
}  // namespace tessera::frame::lattice_frame_test
