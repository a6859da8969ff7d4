#pragma once

#include <cstddef>
#include <exception>
#include <optional>
#include <vector>

#include "exchange/transport.hpp"
#include "frame/stop_relay.hpp"
#include "scene/frame_watch.hpp"
#include "scene/grid.hpp"
#include "volume/cost_map.hpp"
#include "volume/render.hpp"
#include "volume/voxel_box.hpp"

namespace tessera::frame {

struct VolumeJob {
  scene::Camera camera;
  scene::ImageSize size;
};

/// A finished picture, on rank 0.
struct FinishedVolumeFrame {
  std::size_t frame;
  scene::Image image;
  volume::RenderStatistics statistics;    ///< of all ranks, put together as tessera::grid_counters says
  std::vector<scene::PixelRect> regions;  ///< of each rank: the pixels that it finished
  std::vector<GridCounters> ranks;        ///< what `statistics` are put together of
  std::vector<double> cpu_seconds;        ///< of each rank's rendering, all its threads
  std::vector<double> split_cpu_seconds;  ///< sort-first: of each rank's part in finding the split
  double frame_ms;                        ///< from when all ranks were ready to the picture in memory, split included
  std::vector<float> error_bounds;        ///< by pixel, if asked for
  bool stopped = false;                   ///< the image lacks pixels
  volume::ImageSplit split;               ///< sort-first: what `regions` are of
  volume::CostMap cost;                   ///< sort-first: of the whole picture, if SortFirstSettings::keep_cost
  std::vector<volume::VoxelBox> parts;    ///< sort-last: of each rank
};

/// Renders pictures of volumes with all ranks of a transport: sort-first (sort_first.hpp) or sort-last (sort_last.hpp).
class VolumeFrames {
 public:
  /// `transport` must outlive it.
  explicit VolumeFrames(exchange::Transport& transport) : transport_(transport), relay_(transport) {}
  virtual ~VolumeFrames() = default;
  VolumeFrames(const VolumeFrames&) = delete;
  VolumeFrames& operator=(const VolumeFrames&) = delete;

  /// The picture on rank 0, nothing elsewhere. Collective: the same arguments on every rank, but for the renderer,
  /// which is each rank's own. Throws the run's error, or this rank's, which the caller gives to transport.fail().
  ///
  /// `watch` hears on rank 0 of pixels that are final, those of other ranks by whole rectangles; its stop, asked for on
  /// any rank, ends the picture on all within a tile of rays. All return and can go on.
  std::optional<FinishedVolumeFrame> render(volume::Renderer& renderer, const scene::TransferFunction& function,
                                            const VolumeJob& job, std::size_t number,
                                            scene::FrameWatch* watch = nullptr);

  /// Carries stops between the ranks, for what follows a picture. Not while render() runs.
  StopRelay& relay() { return relay_; }

 protected:
  /// What render() says, of a watch that stops on all ranks together.
  virtual std::optional<FinishedVolumeFrame> make(volume::Renderer& renderer, const scene::TransferFunction& function,
                                                  const VolumeJob& job, std::size_t number,
                                                  scene::FrameWatch& watch) = 0;

  exchange::Transport& transport_;

 private:
  StopRelay relay_;
};

}  // namespace tessera::frame
