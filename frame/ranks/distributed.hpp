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

/// A session's settings, and what differs between its lists of frames and its ranks.
struct DistributedSettings {
  Settings render;        ///< `memory_bytes` and `threads` apply to each rank; `trace` is not used
  FrameSettings frame{};  ///< deep images, and layers, need raw segments
  Roles roles{};
  Exchange exchange = Exchange::runs;   ///< replaces RankSettings::exchange
  scene::Trace* projecting = nullptr;   ///< this rank's trace for its projector; null: no timing
  scene::Trace* compositing = nullptr;  ///< the same for its compositor
  compositor::GlSettings gl{};          ///< of devices, in addition to DeviceSettings
  bool software_will_do = false;        ///< tests: Backend::automatic accepts a software device
};

/// One frame to render.
struct FrameJob {
  scene::Camera camera;
  scene::ImageSize size;
  std::size_t mesh = 0;  ///< index of the mesh in a series; ascending
};

/// This projector's part of a mesh.
struct ProjectorMesh {
  scene::TetMeshView part;            ///< may have no tets
  std::shared_ptr<const void> owner;  ///< keeps its arrays, and the indices
  /// The part prepared for projection, if that is done already; null: it is done here.
  std::shared_ptr<const projection::PreparedMesh> prepared{};
  std::span<const std::uint64_t> global_tet{};  ///< index in the whole mesh of each tet, ascending; empty: its own
  double diagonal = 0;                          ///< of the whole mesh's box, world units
  scene::Box box;                               ///< of the whole mesh
  std::array<double, 2> scalar_range{};         ///< of the whole mesh
  float longest_edge = 0;                       ///< scanline: of the whole mesh, world units
};

/// A finished frame, on the assembling rank.
struct FinishedFrame {
  std::size_t frame;
  scene::Image image;
  scene::DeepImage deep;       ///< if requested
  FrameStatistics statistics;  ///< of all ranks
  double frame_ms;             ///< since the frame before it was complete, or since all ranks were ready
  bool stopped = false;        ///< the image lacks tiles
  bool overlapping = false;    ///< runs were sent that overlap: the image may be wrong
};

/// Callbacks on the assembling rank, called from any thread, one at a time. An exception stops the run on all ranks and
/// propagates from render() on this one.
struct DistributedCallbacks {
  std::function<void(FinishedFrame)> frame;  ///< every frame, in order, including stopped ones
  /// Final pixels of a frame, possibly of a later frame than the current one. May be empty.
  std::function<void(std::size_t frame, const scene::PixelRect& rect, const scene::Image& image)> tile;
  /// An image whose memory a frame may reuse, whatever it contains; ignored if its size differs. May be empty.
  std::function<scene::Image(scene::ImageSize size)> memory;
};

/// Renders frames of meshes with all ranks of a transport: each rank constructs one, with the same arguments except for
/// the traces and the function, which does the work of its own rank:
///   mesh_of(m)     on every rank, once per mesh, in order, collective: loads this rank's part of mesh m
/// Projectors send tile by tile while they project; frame i projects while frame i - 1 composites. Only the order of
/// frames synchronises ranks.
class DistributedRenderer {
 public:
  using MeshOf = std::function<ProjectorMesh(std::size_t)>;

  /// The settings must be valid for meshes. Throws Error(bad_input) for what several ranks or devices do not support.
  /// `transport` must outlive this object.
  DistributedRenderer(exchange::Transport& transport, DistributedSettings settings, MeshOf mesh_of);
  ~DistributedRenderer();
  DistributedRenderer(const DistributedRenderer&) = delete;
  DistributedRenderer& operator=(const DistributedRenderer&) = delete;

  /// Renders a list of frames, with deep images if DistributedSettings::frame requests them. Collective: the same jobs
  /// and function on every rank. One transfer function applies to all of them, so that a film does not flicker. If
  /// `stop` is requested on any rank, the list ends early on all, within one batch of cells; all ranks return and
  /// remain usable. Throws the run's error, on every rank.
  void render(std::span<const FrameJob> jobs, const scene::TransferFunction& function,
              const DistributedCallbacks& callbacks, const std::stop_token& stop = {});
  /// Sets the options of later lists. Throws Error(bad_input) if the settings do not support them.
  void set_frame(const FrameSettings& frame, Exchange exchange);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// The same for one list, without tiles: `done` gets every frame.
void render_distributed(exchange::Transport& transport, const DistributedSettings& settings,
                        std::span<const FrameJob> jobs, const scene::TransferFunction& function,
                        const std::function<ProjectorMesh(std::size_t)>& mesh_of,
                        const std::function<void(FinishedFrame)>& done);

}  // namespace tessera::frame
