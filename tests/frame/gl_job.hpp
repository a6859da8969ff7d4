// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "datasets/boxes.hpp"
#include "exchange/loopback_transport.hpp"
#include "frame/image_difference.hpp"
#include "frame/ranks/distributed.hpp"
#include "projection/scanline/segment_tuple.hpp"
#include "scene/mesh_facts.hpp"
#include "support/gl_context.hpp"

/// Jobs of ranks in one process whose compositors have devices, for tests.
namespace tessera::frame {

using scene::Image;
using scene::ImageSize;

inline scene::TransferFunction bands() {
  return scene::TransferFunction({{0, {0, 0, 0.3}, 0},
                                  {0.3, {0.1, 0.3, 0.9}, 0.4},
                                  {0.5, {0.2, 0.9, 0.3}, 0},
                                  {0.7, {0.9, 0.8, 0.1}, 3},
                                  {0.8, {1, 0.3, 0}, 0.2},
                                  {1, {1, 1, 1}, 8}});
}

inline scene::Camera camera(bool inside) {
  scene::Camera camera;
  camera.position = inside ? glm::dvec3(0.1, 0.2, 0.15) : glm::dvec3(3.1, 2.3, 4.2);
  camera.parallel_scale = 1.8;
  camera.view_angle = 80;
  if (inside) camera.projection = scene::ProjectionKind::perspective;
  return camera;
}

/// A small cube of 6 * 6^3 tets on `projectors` + `compositors` ranks, every third tet on the same projector.
struct GlJobSetup {
  int projectors = 1, compositors = 1;
  std::vector<Backend> backends = {Backend::osmesa};
  Exchange exchange = Exchange::segments;
  scene::IntegratorKind integrator = scene::IntegratorKind::exact;
  Rasterizer rasterizer = Rasterizer::planes;
  bool inside = false, shared = false;
  compositor::GlSettings gl{};
  int frames = 1;
  std::optional<scene::Camera> view{};  ///< instead of camera(inside)
  scene::TransferFunction function = bands();
  int tile_size = 16;
  bool software_will_do = true;  ///< for Backend::automatic
  [[nodiscard]] scene::Camera camera_used() const { return view ? *view : camera(inside); }
};
constexpr ImageSize gl_job_size{48, 40};

inline std::vector<FinishedFrame> rendered(const GlJobSetup& setup, const scene::TetMesh& mesh) {
  const scene::MeshFacts facts = scene::facts_of(mesh);
  const int ranks = setup.shared ? std::max(setup.projectors, setup.compositors) : setup.projectors + setup.compositors;
  DistributedSettings settings;
  settings.render.integrator.kind = setup.integrator;
  settings.render.integrator.samples = 5;
  settings.render.mesh.rasterizer = setup.rasterizer;
  settings.render.threads = 1;
  settings.render.mesh.tile_size = setup.tile_size;
  settings.exchange = setup.exchange;
  settings.render.mesh.device = {.backends = setup.backends, .method = setup.gl.method, .half = setup.gl.half};
  settings.gl = setup.gl;
  settings.software_will_do = setup.software_will_do;
  settings.roles = assign_roles(ranks, setup.projectors, setup.compositors);
  std::vector<FinishedFrame> frames;
  exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
    render_distributed(
        transport, settings,
        std::vector<FrameJob>(static_cast<std::size_t>(setup.frames), {setup.camera_used(), gl_job_size}),
        setup.function,
        [&](std::size_t) {
          ProjectorMesh part;
          auto tets = std::make_shared<scene::TetMesh>(mesh);
          tets->tets.clear();
          tets->original_cell.clear();
          for (std::size_t t = 0; t < mesh.tets.size(); ++t)
            if (static_cast<int>(t / 3) % setup.projectors == transport.rank()) {
              tets->tets.push_back(mesh.tets[t]);
              tets->original_cell.push_back(t);
            }
          part.part = *tets;
          part.global_tet = tets->original_cell;
          part.owner = tets;
          part.diagonal = 4;
          part.box = facts.box;
          part.scalar_range = facts.scalar_range;
          part.longest_edge = projection::longest_edge(mesh);
          return part;
        },
        [&](FinishedFrame frame) { frames.push_back(std::move(frame)); });
  });
  return frames;
}

inline scene::TetMesh small_cube() { return datasets::cube(6); }

#define TESSERA_NEEDS_OSMESA() \
  if (tests::osmesa_or_none() == nullptr) GTEST_SKIP() << "OSMesa cannot be opened"

}  // namespace tessera::frame
