// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "scene/camera.hpp"
#include "scene/deep_image.hpp"
#include "scene/frame_counters.hpp"
#include "scene/frame_watch.hpp"
#include "scene/image.hpp"
#include "scene/mesh_facts.hpp"
#include "scene/tet_mesh.hpp"
#include "scene/trace.hpp"
#include "scene/transfer_function.hpp"
#include "tessera/settings.hpp"

namespace tessera::projection {
class PreparedMesh;
}

namespace tessera::frame {

/// What happened in one frame.
struct FrameStatistics : scene::FrameCounters {
  bool on_lattice = false;      ///< the integer lattice held the frame; false: double precision
  std::string instruction_set;  ///< of the kernels that ran
  std::string integrator;       ///< what `automatic` chose
  std::string composited_on;    ///< CompositingDevice::name, of all compositors; empty in a single process
};

/// projection::order_corners() on so many threads, 0: all cores: of a mesh that has been through it a renderer keeps no
/// copy of the tets, 16 bytes each. Pictures are the same with and without.
void order_corners(scene::TetMesh& mesh, int threads, scene::Trace* trace = nullptr);

/// Renders one tetrahedral mesh many times in one process, by settings that are valid for meshes (tessera::validate),
/// iso-surfaces only of point data. Only the rasterizer, integrator, emission, surfaces, shading and Settings::use
/// change a bit of the picture. Preparation that does not depend on view or transfer function happens in the
/// constructor; the mesh must outlive the renderer and not change.
class Renderer {
 public:
  Renderer(const scene::TetMeshView& mesh, const Settings& settings);
  /// Of a mesh that has been prepared, with what is known of it.
  Renderer(const std::shared_ptr<const projection::PreparedMesh>& mesh, const scene::MeshFacts& facts,
           const Settings& settings);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// The composited image in memory. The same bits for any thread count, tile size and memory budget on one instruction
  /// set. Throws Error(bad_input) for an invalid camera or size, or a view that the rasterizer cannot do;
  /// Error(system_failure) if one pixel's segments exceed the budget.
  ///
  /// With `deep` also the deep picture of the same frame, or its layers, as set_frame() says; half the memory budget is
  /// kept for it. Throws Error(system_failure) if its samples exceed their half.
  ///
  /// `watch` hears of every tile as it is finished, those without cells included; once it is asked to stop, render()
  /// throws scene::FrameStopped within a batch of cells, and can be called again.
  scene::Image render(const scene::Camera& camera, scene::ImageSize size,
                      const scene::TransferFunction& transfer_function, FrameStatistics* statistics = nullptr,
                      scene::DeepImage* deep = nullptr, scene::FrameWatch* watch = nullptr);

  /// Of later frames; valid for the settings. With `peel` deep pictures are layers, as PeelSink gives them, not tidy.
  void set_frame(const FrameSettings& frame);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The setting that has surfaces, for messages: `iso` or `surface`.
const char* surface_word(const Surfaces& surfaces);

}  // namespace tessera::frame
