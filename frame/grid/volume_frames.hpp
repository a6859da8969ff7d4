// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "exchange/transport.hpp"
#include "frame/ranks/stop_relay.hpp"
#include "scene/frame_watch.hpp"
#include "scene/grid.hpp"
#include "volume/render.hpp"
#include "volume/split/cost_map.hpp"
#include "volume/split/voxel_box.hpp"

namespace tessera::frame {

struct VolumeJob {
  scene::Camera camera;
  scene::ImageSize size;
};

/// A finished frame, on rank 0.
struct FinishedVolumeFrame {
  std::size_t frame;  ///< in the list
  scene::Image image;
  volume::RenderStatistics statistics;    ///< of all ranks, combined as tessera::grid_counters specifies
  std::vector<scene::PixelRect> regions;  ///< of each rank: the pixels that it finished, except steps in its edges
  std::vector<GridCounters> ranks;        ///< the counters combined in `statistics`
  std::vector<double> cpu_seconds;        ///< of each rank's rendering, all its threads
  std::vector<double> split_cpu_seconds;  ///< sort-first: of each rank's share of finding the split
  double frame_ms;                  ///< from the last frame, or from when all ranks were ready, to this one in memory
  std::vector<float> error_bounds;  ///< by pixel, if requested
  bool stopped = false;             ///< the image lacks pixels
  volume::ImageSplit split;         ///< sort-first: the split into `regions`
  volume::CostMap cost;             ///< sort-first: of the whole image, if FrameSettings::keep_cost
  std::vector<volume::VoxelBox> parts;  ///< sort-last: of each rank
};

/// The header of the pixels that a rank sends.
struct RegionHeader {
  std::uint64_t frame;      ///< number of the frame
  scene::PixelRect region;  ///< without the steps of its edges (volume::ImageSplit)
  GridCounters counters;
  double cpu_seconds, split_cpu_seconds;
  std::uint64_t stopped;  ///< 1: no pixels follow
};
static_assert(sizeof(RegionHeader) == sizeof(GridCounters) + 6 * 8);

/// A rank's part of a frame.
struct VolumePart {
  RegionHeader header;
  std::vector<scene::PixelRect> rectangles;  ///< finished by this rank
  FinishedVolumeFrame finished;              ///< without the other ranks' parts; only these pixels of `image` are valid
};

/// Callbacks on rank 0: one call at a time, from any thread. An exception from a call stops all ranks and propagates
/// from render().
struct VolumeCallbacks {
  std::function<void(FinishedVolumeFrame&&)> frame;  ///< called with each complete frame, in order
  /// Called with final pixels of a frame of the list; those of other ranks by whole rectangles. May be empty.
  std::function<void(std::size_t frame, const scene::PixelRect&, const scene::Image&)> tile;
};

/// Renders frames of volumes with all ranks of a transport: sort-first (sort_first.hpp) or sort-last (sort_last.hpp).
///
/// In a list of frames, ranks cast the next one while a separate thread of rank 0 still gathers the last one and passes
/// it on; the caller limits how many may be in progress.
class VolumeFrames {
 public:
  /// `transport` and `trace`, which may be null, must outlive this object.
  VolumeFrames(exchange::Transport& transport, scene::Trace* trace)
      : transport_(transport), trace_(trace), relay_(transport) {}
  virtual ~VolumeFrames() = default;
  VolumeFrames(const VolumeFrames&) = delete;
  VolumeFrames& operator=(const VolumeFrames&) = delete;

  /// Returns how many frames of the list are complete, on every rank: all, unless a callback threw or `stop` was
  /// requested on any rank, which ends the list on all ranks within a tile of rays. Collective: the same arguments on
  /// every rank except the renderer, which is each rank's own, `stop` and the callbacks. Traces number the frames
  /// `first`, `first` + 1 and so on. Throws the run's error.
  std::size_t render(volume::Renderer& renderer, const scene::TransferFunction& function,
                     std::span<const VolumeJob> jobs, std::size_t first, const VolumeCallbacks& callbacks,
                     const std::stop_token& stop, int in_flight);

  /// Renders one frame: returned on rank 0, stopped if it was; nothing on others. `watch` receives pixels as above.
  std::optional<FinishedVolumeFrame> render(volume::Renderer& renderer, const scene::TransferFunction& function,
                                            const VolumeJob& job, std::size_t number,
                                            scene::FrameWatch* watch = nullptr);

  /// Passes stops between the ranks, for work that follows a frame. Not while render() runs.
  StopRelay& relay() { return relay_; }

 protected:
  /// Casts this rank's part of a frame. `watch` receives its final pixels. The header states whether it was stopped.
  virtual VolumePart make(volume::Renderer& renderer, const scene::TransferFunction& function, const VolumeJob& job,
                          std::size_t number, scene::FrameWatch& watch) = 0;

  exchange::Transport& transport_;
  scene::Trace* trace_;

 private:
  class List;
  StopRelay relay_;
};

/// CPU time of all threads of this process so far.
double process_cpu_seconds();

}  // namespace tessera::frame
