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

/// Statistics of one frame.
struct FrameStatistics : scene::FrameCounters {
  bool on_lattice = false;      ///< whether the integer lattice was precise enough; false: double precision was used
  std::string instruction_set;  ///< instruction set of the kernels that ran
  std::string integrator;       ///< the integrator that was used, also where the setting is `automatic`
  std::string composited_on;    ///< names (CompositingDevice::name) for all compositors; empty in a single process
};

/// Renders one tetrahedral mesh many times in one process, with settings that are valid for meshes (tessera::validate);
/// iso-surfaces need point data. The bits of the image depend on these settings only: rasterizer, integrator, emission,
/// surfaces, shading and Settings::use. The constructor does the preparation that does not depend on view or transfer
/// function; the mesh must outlive the renderer and not change.
class Renderer {
 public:
  Renderer(const scene::TetMeshView& mesh, const Settings& settings);
  /// Uses a mesh that has already been prepared; `facts` are the facts of that mesh.
  Renderer(const std::shared_ptr<const projection::PreparedMesh>& mesh, const scene::MeshFacts& facts,
           const Settings& settings);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Returns the composited image. On one instruction set, the image has the same bits for any number of threads, tile
  /// size and memory budget. Throws Error(bad_input) for an invalid camera or size, or a view that the rasterizer does
  /// not support. Throws Error(system_failure) if the segments of one pixel exceed the budget.
  ///
  /// If `deep` is not null, also renders the deep image of the same frame, or its layers, depending on set_frame();
  /// half of the memory budget is reserved for this. Throws Error(system_failure) if the samples exceed that half.
  ///
  /// `watch` receives every finished tile, including tiles without cells. If `watch` requests a stop, render() throws
  /// scene::FrameStopped within a batch of cells; render() can then be called again.
  scene::Image render(const scene::Camera& camera, scene::ImageSize size,
                      const scene::TransferFunction& transfer_function, FrameStatistics* statistics = nullptr,
                      scene::DeepImage* deep = nullptr, scene::FrameWatch* watch = nullptr);

  /// Sets the options of later frames, which must be valid for the settings. With `peel`, deep images consist of
  /// layers, as PeelSink makes them, and are not made tidy.
  void set_frame(const FrameSettings& frame);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The name that messages use for the setting of surfaces: `iso` or `surface`.
const char* surface_word(const Surfaces& surfaces);

}  // namespace tessera::frame
