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
  Settings render;        ///< `memory_bytes` and `threads` are each rank's; `trace` is not used
  FrameSettings frame{};  ///< deep pictures, and layers, need raw segments
  Roles roles{};
  Exchange exchange = Exchange::runs;   ///< in place of RankSettings::exchange
  scene::Trace* projecting = nullptr;   ///< face of this rank's trace for its projector; null: no timing
  scene::Trace* compositing = nullptr;  ///< for its compositor
  compositor::GlSettings gl{};          ///< of devices, besides what DeviceSettings specify
  bool software_will_do = false;        ///< tests: Backend::automatic takes a software device
};

/// One picture to make.
struct FrameJob {
  scene::Camera camera;
  scene::ImageSize size;
  std::size_t mesh = 0;  ///< which mesh of a series; ascending
};

/// This projector's part of a mesh.
struct ProjectorMesh {
  scene::TetMeshView part;            ///< may have no tets
  std::shared_ptr<const void> owner;  ///< keeps its arrays, and the indices
  /// The part prepared for projection, if somebody has done it; null: it is done here.
  std::shared_ptr<const projection::PreparedMesh> prepared{};
  std::span<const std::uint64_t> global_tet{};  ///< index in the whole mesh of each tet, ascending; empty: its own
  double diagonal = 0;                          ///< of the whole mesh's box, world units
  scene::Box box;                               ///< of the whole mesh
  std::array<double, 2> scalar_range{};         ///< of the whole mesh
  float longest_edge = 0;                       ///< scanline: of the whole mesh, world units
};

/// A finished picture, on the assembling rank.
struct FinishedFrame {
  std::size_t frame;
  scene::Image image;
  scene::DeepImage deep;       ///< if asked for
  FrameStatistics statistics;  ///< of all ranks
  double frame_ms;             ///< since the frame before it was complete, or since all ranks were ready
  bool stopped = false;        ///< the image lacks tiles
  bool overlapping = false;    ///< runs were sent that overlap: the image may be wrong
};

/// What the assembling rank's caller is told, from any thread, one call at a time. An exception stops the run on all
/// ranks and comes out of render() on this one.
struct DistributedCallbacks {
  std::function<void(FinishedFrame)> frame;  ///< every frame, in order, stopped ones too
  /// Pixels of a frame that are final; perhaps of a later frame than the one at hand. May be empty.
  std::function<void(std::size_t frame, const scene::PixelRect& rect, const scene::Image& image)> tile;
  /// An image whose memory a frame may have, whatever is in it; of another size: none. May be empty.
  std::function<scene::Image(scene::ImageSize size)> memory;
};

/// Renders pictures of meshes with all ranks of a transport: each makes one, with the same arguments but for the traces
/// and the function, which runs where its work is:
///   mesh_of(m)     on every rank, once a mesh, in order, collective: loads this rank's part of mesh m
/// Projectors stream tile by tile while they project; frame i projects while frame i - 1 composites. Nothing but the
/// order of frames synchronises ranks.
class DistributedRenderer {
 public:
  using MeshOf = std::function<ProjectorMesh(std::size_t)>;

  /// Of settings that are valid for meshes. Throws Error(bad_input) for what several ranks or devices cannot do.
  /// `transport` must outlive this object.
  DistributedRenderer(exchange::Transport& transport, DistributedSettings settings, MeshOf mesh_of);
  ~DistributedRenderer();
  DistributedRenderer(const DistributedRenderer&) = delete;
  DistributedRenderer& operator=(const DistributedRenderer&) = delete;

  /// Makes a list of pictures, deep ones too if DistributedSettings::frame asks for them. Collective: the same
  /// jobs and function on every rank. The transfer function is one for all of them, so that a film does not flicker.
  /// `stop`, asked for on any rank, ends the list early on all, within one batch of cells; all return and can go on.
  /// Throws the run's error, on every rank.
  void render(std::span<const FrameJob> jobs, const scene::TransferFunction& function,
              const DistributedCallbacks& callbacks, const std::stop_token& stop = {});
  /// Of later lists. Throws Error(bad_input) where the settings cannot do it.
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
