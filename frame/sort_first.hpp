#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "exchange/transport.hpp"
#include "frame/stop_relay.hpp"
#include "scene/frame_watch.hpp"
#include "scene/grid.hpp"
#include "tessera/settings.hpp"
#include "volume/cost_map.hpp"
#include "volume/render.hpp"

namespace tessera::frame {

using tessera::Balance;

struct SortFirstSettings {
  Balance balance = Balance::learned;
  double resolution = 0.5;      ///< of the cost map, map pixels an image pixel along each axis
  std::vector<double> weights;  ///< how much of the work each rank should get; empty: equal
  bool measured = false;        ///< in place of weights: each rank's speed in the frames before
  bool keep_cost = false;       ///< rank 0 finds the cost of the whole picture too, to be shown
  bool keep_error_bounds =
      false;  ///< rank 0 gets each pixel's error bound (volume::Renderer::render) too; alike on all ranks
  scene::Trace* trace = nullptr;
};

struct VolumeJob {
  scene::Camera camera;
  scene::ImageSize size;
};

/// A finished picture, on rank 0.
struct FinishedVolumeFrame {
  std::size_t frame;
  scene::Image image;
  volume::RenderStatistics statistics;  ///< of all ranks, put together as tessera::grid_counters says
  volume::ImageSplit split;
  std::vector<std::uint64_t> samples;     ///< of each rank
  std::vector<GridCounters> ranks;        ///< what `statistics` is put together of
  std::vector<double> cpu_seconds;        ///< of each rank's rendering, all its threads
  std::vector<double> split_cpu_seconds;  ///< of each rank's part in finding the split
  double frame_ms;                        ///< from when all ranks were ready to the picture in memory, split included
  volume::CostMap cost;                   ///< of the whole picture, if SortFirstSettings::keep_cost
  std::vector<float> error_bounds;        ///< by pixel, if SortFirstSettings::keep_error_bounds
  bool stopped = false;                   ///< the image lacks pixels
};

/// Renders pictures of volumes with all ranks of `transport` (sort first): each casts the rays of one rectangle through
/// its own renderer of the same volume, rank 0 gathers (Moloney, "Ray Coherence in Parallel Volume Rendering", SFU
/// 2008, 6.3.2). A single rank casts all and splits nothing.
///
/// The split is found by all ranks together in two stages (volume/image_split.hpp): each finds the cost of the
/// rectangle it had in the frame before, of an even tile in the first one. The bits of the picture are those of one
/// process, for any split.
class SortFirst {
 public:
  /// Throws Error(bad_input) unless there are no weights or as many positive ones as ranks. `transport` must outlive
  /// it.
  SortFirst(exchange::Transport& transport, SortFirstSettings settings);
  ~SortFirst();
  SortFirst(const SortFirst&) = delete;
  SortFirst& operator=(const SortFirst&) = delete;

  /// The picture on rank 0, nothing elsewhere. Collective: the same arguments on every rank, but for the renderer,
  /// which is each rank's own. Throws the run's error, or this rank's, which the caller gives to transport.fail().
  ///
  /// `watch` hears on rank 0 of pixels that are final, those of other ranks by whole rectangles; its stop, asked for on
  /// any rank, ends the picture on all within a tile of rays. All return and can go on.
  std::optional<FinishedVolumeFrame> render(volume::Renderer& renderer, const scene::TransferFunction& function,
                                            const VolumeJob& job, std::size_t number,
                                            scene::FrameWatch* watch = nullptr);

  /// Carries stops between the ranks, for what follows a picture. Not while render() runs.
  StopRelay& relay();

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace tessera::frame
