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
  std::size_t frame;  ///< index in the list of jobs
  scene::Image image;
  volume::RenderStatistics statistics;    ///< statistics of all ranks, combined as tessera::grid_counters specifies
  std::vector<scene::PixelRect> regions;  ///< for each rank, its region without the steps of its edges
  std::vector<GridCounters> ranks;        ///< the counters combined in `statistics`
  std::vector<double> cpu_seconds;        ///< for each rank, CPU time of rendering, summed over its threads
  std::vector<double> split_cpu_seconds;  ///< sort-first: for each rank, CPU time of its share of finding the split
  double frame_ms;  ///< time from the completion of the last frame, or from when all ranks were ready, until this frame
                    ///< is in memory
  std::vector<float> error_bounds;      ///< one per pixel, if requested
  bool stopped = false;                 ///< the image lacks pixels
  volume::ImageSplit split;             ///< sort-first: the split into `regions`
  volume::CostMap cost;                 ///< sort-first: cost of the whole image, if FrameSettings::keep_cost is set
  std::vector<volume::VoxelBox> parts;  ///< sort-last: the box of each rank
};

/// Header of the message in which a rank sends its pixels.
struct RegionHeader {
  std::uint64_t frame;      ///< number of the frame
  scene::PixelRect region;  ///< the rank's region, excluding the steps of its edges (volume::ImageSplit)
  GridCounters counters;
  double cpu_seconds, split_cpu_seconds;
  std::uint64_t stopped;  ///< 1: the frame was stopped, and no pixels follow
};
static_assert(sizeof(RegionHeader) == sizeof(GridCounters) + 6 * 8);

/// A rank's part of a frame.
struct VolumePart {
  RegionHeader header;
  std::vector<scene::PixelRect> rectangles;  ///< finished by this rank
  FinishedVolumeFrame finished;  ///< lacks the other ranks' parts; only the pixels of this part are valid in `image`
};

/// Callbacks on rank 0. They are called from any thread, but one at a time. An exception from a callback stops all
/// ranks and propagates from render().
struct VolumeCallbacks {
  std::function<void(FinishedVolumeFrame&&)> frame;  ///< called with each complete frame, in order
  /// Called with final pixels of a frame of the list; other ranks' pixels arrive as whole rectangles. May be empty.
  std::function<void(std::size_t frame, const scene::PixelRect&, const scene::Image&)> tile;
};

/// Renders frames of volumes with all ranks of a transport: sort-first (sort_first.hpp) or sort-last (sort_last.hpp).
///
/// In a list of frames, ranks already cast the next frame while a separate thread of rank 0 gathers the last frame and
/// passes it to the callbacks. The caller limits how many frames may be in progress.
class VolumeFrames {
 public:
  /// `transport` and `trace`, which may be null, must outlive this object.
  VolumeFrames(exchange::Transport& transport, scene::Trace* trace)
      : transport_(transport), trace_(trace), relay_(transport) {}
  virtual ~VolumeFrames() = default;
  VolumeFrames(const VolumeFrames&) = delete;
  VolumeFrames& operator=(const VolumeFrames&) = delete;

  /// Renders a list of frames, with at most `in_flight` frames in progress. Returns on every rank how many frames of
  /// the list are complete: all of them, unless a callback threw or `stop` was requested on any rank. Both end the list
  /// on all ranks within one tile of rays. Collective: every rank passes the same arguments, except for the renderer,
  /// which is its own, `stop` and the callbacks. Traces number the frames `first`, `first` + 1 and so on. Throws the
  /// run's error.
  std::size_t render(volume::Renderer& renderer, const scene::TransferFunction& function,
                     std::span<const VolumeJob> jobs, std::size_t first, const VolumeCallbacks& callbacks,
                     const std::stop_token& stop, int in_flight);

  /// Renders one frame and returns it on rank 0, marked as stopped if it was stopped; returns nothing on other ranks.
  /// `watch` receives final pixels.
  std::optional<FinishedVolumeFrame> render(volume::Renderer& renderer, const scene::TransferFunction& function,
                                            const VolumeJob& job, std::size_t number,
                                            scene::FrameWatch* watch = nullptr);

  /// Passes stops between the ranks, for work that follows a frame. Must not be used while render() runs.
  StopRelay& relay() { return relay_; }

 protected:
  /// Casts this rank's part of a frame and reports its final pixels to `watch`. The returned header states whether the
  /// part was stopped.
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
