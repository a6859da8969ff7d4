// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "scene/camera.hpp"
#include "scene/deep_image.hpp"
#include "scene/frame_counters.hpp"
#include "scene/frame_watch.hpp"
#include "scene/image.hpp"
#include "scene/mechanisms.hpp"
#include "scene/mesh_facts.hpp"
#include "scene/optical_model.hpp"
#include "scene/shading.hpp"
#include "scene/surface_set.hpp"
#include "scene/tet_mesh.hpp"
#include "scene/trace.hpp"
#include "scene/transfer_function.hpp"
#include "tessera/settings.hpp"

namespace tessera::projection {
class PreparedMesh;
}

namespace tessera::frame {

using tessera::Rasterizer;

/// What a frame is made with. None of it but the rasterizer, integrator, emission, surfaces, shading, accuracy and
/// `use` changes a bit of the picture.
struct RenderSettings {
  Rasterizer rasterizer = Rasterizer::planes;
  scene::Integrator integrator;
  scene::Emission emission = scene::Emission::absorption;
  scene::Surfaces surfaces{};               ///< checked by check_surfaces()
  std::optional<scene::Shading> shading{};  ///< of point data, checked by check_shading()
  double deep_accuracy = 1e-3;              ///< of a deep picture, cut anywhere: largest error in linear RGBA
  std::optional<Peel> peel{};               ///< deep pictures are layers, as PeelSink gives them, not tidy
  scene::Mechanisms use;                    ///< what saves work
  bool bounded = true;                      ///< false: composited on a device whose error is only reported
  int threads = 0;                          ///< 0: all cores
  int tile_size = 32;                       ///< pixels a side, 1..1024
  std::uint64_t memory_bytes = 4ull << 30;  ///< budget for frame buffers of all threads beside the mesh
  scene::Trace* trace = nullptr;            ///< null: no timing
};

/// What happened in one frame.
struct FrameStatistics : scene::FrameCounters {
  bool on_lattice = false;      ///< the integer lattice held the frame; false: double precision
  std::string instruction_set;  ///< of the kernels that ran
  std::string integrator;       ///< what `automatic` chose
  std::string composited_on;    ///< CompositingDevice::name, of all compositors; empty in a single process
};

/// projection::order_corners() on the threads of `settings`: of a mesh that has been through it a renderer keeps no
/// copy of the tets, 16 bytes each. Pictures are the same with and without.
void order_corners(scene::TetMesh& mesh, const RenderSettings& settings);

/// Renders one tetrahedral mesh many times in one process. Preparation that does not depend on view or transfer
/// function happens in the constructor; the mesh must outlive the renderer and not change.
class Renderer {
 public:
  Renderer(const scene::TetMeshView& mesh, const RenderSettings& settings);
  /// Of a mesh that has been prepared, with what is known of it.
  Renderer(const std::shared_ptr<const projection::PreparedMesh>& mesh, const scene::MeshFacts& facts,
           const RenderSettings& settings);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// The composited image in memory. The same bits for any thread count, tile size and memory budget on one instruction
  /// set. Throws Error(bad_input) for an invalid camera or size, or a view that the rasterizer cannot do;
  /// Error(system_failure) if one pixel's segments exceed the budget.
  ///
  /// With `deep` also the deep picture of the same frame, for which half the memory budget is kept: flattened it is the
  /// image; cut anywhere in depth by OpenEXR's rules its error is below `deep_accuracy`. It needs the planes rasterizer
  /// and an exact integrator (exact, automatic), else Error(bad_input); Error(system_failure) if its samples exceed
  /// their half.
  ///
  /// `watch` hears of every tile as it is finished, those without cells included; once it is asked to stop, render()
  /// throws scene::FrameStopped within a batch of cells, and can be called again.
  scene::Image render(const scene::Camera& camera, scene::ImageSize size,
                      const scene::TransferFunction& transfer_function, FrameStatistics* statistics = nullptr,
                      scene::DeepImage* deep = nullptr, scene::FrameWatch* watch = nullptr);

  /// RenderSettings::deep_accuracy and RenderSettings::peel of later frames.
  void set_deep(double accuracy, const std::optional<Peel>& peel);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Throws Error(bad_input) where deep pictures cannot be made with these settings.
void check_deep(const RenderSettings& settings, const scene::TransferFunction& function);

/// The setting that has surfaces, for messages: `iso` or `surface`.
const char* surface_word(const scene::Surfaces& surfaces);

/// Throws Error(bad_input) where surfaces are out of range, or cannot be rendered of this mesh with these settings.
void check_surfaces(const RenderSettings& settings, scene::Association association);

/// Throws Error(bad_input) where a mesh cannot be shaded with these settings.
void check_shading(const RenderSettings& settings);

}  // namespace tessera::frame
