// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>

#include "compositor/gl/gl_compositor.hpp"
#include "exchange/transport.hpp"
#include "frame/mesh/render.hpp"
#include "frame/ranks/roles.hpp"
#include "scene/pixel_rect.hpp"
#include "tessera/settings.hpp"

namespace tessera::frame {

/// The settings of a session, together with those that differ between its lists of frames or between its ranks.
struct DistributedSettings {
  Settings render;        ///< `memory_bytes` and `threads` apply to each rank; `trace` is not used
  FrameSettings frame{};  ///< deep images and layers require the exchange of raw segments
  Roles roles{};
  Exchange exchange = Exchange::runs;   ///< replaces RankSettings::exchange
  scene::Trace* projecting = nullptr;   ///< trace for this rank's projector; null: no timing
  scene::Trace* compositing = nullptr;  ///< trace for this rank's compositor; null: no timing
  compositor::GlSettings gl{};          ///< settings of devices, in addition to DeviceSettings
  bool software_will_do = false;        ///< for tests: Backend::automatic accepts a software device
};

/// One frame to render.
struct FrameJob {
  scene::Camera camera;
  scene::ImageSize size;
  std::size_t mesh = 0;  ///< index of the mesh in a series; must ascend from job to job
};

/// This projector's part of a mesh.
struct ProjectorMesh {
  scene::TetMeshView part;            ///< may have no tets
  std::shared_ptr<const void> owner;  ///< keeps the arrays of `part` and the indices in memory
  /// The part prepared for projection, if it has been prepared already; null: DistributedRenderer prepares it.
  std::shared_ptr<const projection::PreparedMesh> prepared{};
  /// Index of each tet in the whole mesh, ascending; empty: the index in `part`.
  std::span<const std::uint64_t> global_tet{};
  double diagonal = 0;                   ///< diagonal of the whole mesh's box, world units
  scene::Box box;                        ///< box of the whole mesh
  std::array<double, 2> scalar_range{};  ///< scalar range of the whole mesh
  float longest_edge = 0;                ///< scanline: longest edge of the whole mesh, world units
};

/// A finished frame, on the assembling rank.
struct FinishedFrame {
  std::size_t frame;
  scene::Image image;
  scene::DeepImage deep;       ///< if requested
  FrameStatistics statistics;  ///< combined statistics of all ranks
  double frame_ms;             ///< time since the previous frame was complete, or since all ranks were ready
  bool stopped = false;        ///< the image lacks tiles
  bool overlapping = false;    ///< whether some of the runs that were sent overlap: the image may then be wrong
};

/// Callbacks on the assembling rank, called from any thread, one at a time. An exception stops the run on all ranks and
/// propagates from render() on this one.
struct DistributedCallbacks {
  std::function<void(FinishedFrame)> frame;  ///< called with every frame, in order, including stopped frames
  /// Final pixels of a frame, possibly of a later frame than the current one. May be empty.
  std::function<void(std::size_t frame, const scene::PixelRect& rect, const scene::Image& image)> tile;
  /// Returns an image whose memory a frame may reuse, whatever it contains; it is ignored if its size differs. May be
  /// empty.
  std::function<scene::Image(scene::ImageSize size)> memory;
};

/// Renders frames of meshes with all ranks of a transport. Each rank constructs one, with the same arguments except for
/// the traces and `mesh_of`, which does the work of its own rank:
///   mesh_of(m)     loads this rank's part of mesh m. Called on every rank, once per mesh, in order; collective
/// Projectors send tile by tile while they project; frame i is projected while frame i - 1 is composited. Ranks are
/// synchronised only by the order of frames.
class DistributedRenderer {
 public:
  using MeshOf = std::function<ProjectorMesh(std::size_t)>;

  /// The settings must be valid for meshes. Throws Error(bad_input) if several ranks or devices do not support them.
  /// `transport` must outlive this object.
  DistributedRenderer(exchange::Transport& transport, DistributedSettings settings, MeshOf mesh_of);
  ~DistributedRenderer();
  DistributedRenderer(const DistributedRenderer&) = delete;
  DistributedRenderer& operator=(const DistributedRenderer&) = delete;

  /// Renders a list of frames, with deep images if DistributedSettings::frame requests them. Collective: every rank
  /// passes the same jobs and function. One transfer function applies to all frames, so that a film does not flicker.
  /// If `stop` is requested on any rank, the list ends early on all ranks, within one batch of cells; all ranks return
  /// and remain usable. Throws the run's error on every rank.
  void render(std::span<const FrameJob> jobs, const scene::TransferFunction& function,
              const DistributedCallbacks& callbacks, const std::stop_token& stop = {});
  /// Sets the options of later lists. Throws Error(bad_input) if the settings of this object do not support these
  /// options.
  void set_frame(const FrameSettings& frame, Exchange exchange);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// Renders one list of frames without passing on tiles; `done` is called with every frame.
void render_distributed(exchange::Transport& transport, const DistributedSettings& settings,
                        std::span<const FrameJob> jobs, const scene::TransferFunction& function,
                        const std::function<ProjectorMesh(std::size_t)>& mesh_of,
                        const std::function<void(FinishedFrame)>& done);

}  // namespace tessera::frame
