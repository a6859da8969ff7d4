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

/// A finished picture, on rank 0.
struct FinishedVolumeFrame {
  std::size_t frame;  ///< in the list
  scene::Image image;
  volume::RenderStatistics statistics;    ///< of all ranks, put together as tessera::grid_counters says
  std::vector<scene::PixelRect> regions;  ///< of each rank: the pixels that it finished, but for steps in its edges
  std::vector<GridCounters> ranks;        ///< what `statistics` are put together of
  std::vector<double> cpu_seconds;        ///< of each rank's rendering, all its threads
  std::vector<double> split_cpu_seconds;  ///< sort-first: of each rank's part in finding the split
  double frame_ms;                  ///< from the picture before, or when all ranks were ready, to this one in memory
  std::vector<float> error_bounds;  ///< by pixel, if asked for
  bool stopped = false;             ///< the image lacks pixels
  volume::ImageSplit split;         ///< sort-first: what `regions` are of
  volume::CostMap cost;             ///< sort-first: of the whole picture, if FrameSettings::keep_cost
  std::vector<volume::VoxelBox> parts;  ///< sort-last: of each rank
};

/// What a rank says of the pixels that it finished.
struct RegionHeader {
  std::uint64_t frame;      ///< its number
  scene::PixelRect region;  ///< without the steps of its edges (volume::ImageSplit)
  GridCounters counters;
  double cpu_seconds, split_cpu_seconds;
  std::uint64_t stopped;  ///< 1: no pixels follow
};
static_assert(sizeof(RegionHeader) == sizeof(GridCounters) + 6 * 8);

/// What a rank has made of a picture.
struct VolumePart {
  RegionHeader header;
  std::vector<scene::PixelRect> rectangles;  ///< that it has finished
  FinishedVolumeFrame finished;              ///< but for what the other ranks say, in `image` only these pixels
};

/// On rank 0: who is told of what is made, in one call at a time, from any thread. What a call throws stops all ranks,
/// and comes out of render().
struct VolumeCallbacks {
  std::function<void(FinishedVolumeFrame&&)> frame;  ///< each as it is complete, in order
  /// Of a picture of the list, pixels that are final; those of other ranks by whole rectangles. May be empty.
  std::function<void(std::size_t frame, const scene::PixelRect&, const scene::Image&)> tile;
};

/// Renders pictures of volumes with all ranks of a transport: sort-first (sort_first.hpp) or sort-last (sort_last.hpp).
///
/// Of a list of pictures ranks cast the next one while rank 0 still gathers the one before and hands it out, by a
/// thread of its own; how many may be on their way is up to the caller.
class VolumeFrames {
 public:
  /// `transport` and `trace`, null for none, must outlive it.
  VolumeFrames(exchange::Transport& transport, scene::Trace* trace)
      : transport_(transport), trace_(trace), relay_(transport) {}
  virtual ~VolumeFrames() = default;
  VolumeFrames(const VolumeFrames&) = delete;
  VolumeFrames& operator=(const VolumeFrames&) = delete;

  /// How many pictures of the list are complete, on every rank: all, unless `stop` was asked for on any rank, which
  /// ends the list on all within a tile of rays, or a callback threw. Collective: the same arguments on every rank, but
  /// for the renderer, which is each rank's own, stop and callbacks. Pictures are numbered `first`, `first` + 1 and so
  /// on, in traces. Throws the run's error.
  std::size_t render(volume::Renderer& renderer, const scene::TransferFunction& function,
                     std::span<const VolumeJob> jobs, std::size_t first, const VolumeCallbacks& callbacks,
                     const std::stop_token& stop, int in_flight);

  /// One picture: on rank 0, stopped if it was; nothing elsewhere. `watch` as above.
  std::optional<FinishedVolumeFrame> render(volume::Renderer& renderer, const scene::TransferFunction& function,
                                            const VolumeJob& job, std::size_t number,
                                            scene::FrameWatch* watch = nullptr);

  /// Carries stops between the ranks, for what follows a picture. Not while render() runs.
  StopRelay& relay() { return relay_; }

 protected:
  /// Casts this rank's part of a picture. `watch` hears of its pixels that are final. A stop is said in the header.
  virtual VolumePart make(volume::Renderer& renderer, const scene::TransferFunction& function, const VolumeJob& job,
                          std::size_t number, scene::FrameWatch& watch) = 0;

  exchange::Transport& transport_;
  scene::Trace* trace_;

 private:
  class List;
  StopRelay relay_;
};

/// Processor time of all threads of this process so far.
double process_cpu_seconds();

}  // namespace tessera::frame
