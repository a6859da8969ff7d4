#pragma once

#include <functional>
#include <span>
#include <vector>

#include "compositor/transport.hpp"
#include "scene/grid.hpp"
#include "volume/cost_map.hpp"
#include "volume/render.hpp"

namespace tessera::frame {

/// How the picture of a volume is split between processes ([Mol08] chapter 4).
enum class Balance {
  accurate,  ///< by what each pixel will cost: CostMethod
  backface,
  splatting,
  previous,  ///< by the CPU times of the frame before, each spread evenly over its rectangle; to compare with
  even       ///< equal rectangles of the volume's bounding box
};

struct SortFirstSettings {
  Balance balance = Balance::accurate;
  double resolution = 0.25;     ///< of the cost map, map pixels an image pixel along each axis
  std::vector<double> weights;  ///< how much of the work each rank should get; empty: equal
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
  volume::RenderStatistics statistics;  ///< of all ranks: sums, but `bricks_total`, `bricks_invisible`, `blank_samples`
  volume::ImageSplit split;
  std::vector<std::uint64_t> samples;  ///< of each rank
  std::vector<double> cpu_seconds;     ///< of each rank's rendering, all its threads
  double frame_ms;                     ///< since the frame before it was complete, or since all ranks were ready
};

/// Renders pictures of one volume with all ranks of `transport` (sort first): each casts the rays of one rectangle
/// through its own `renderer` of the same volume, rank 0 gathers ([Mol08] 6.3.2). Each rank calls this with the same
/// arguments but for `done`, which runs on rank 0, in order.
///
/// The split is found by all ranks together in two stages (volume/image_split.hpp): each finds the cost of the
/// rectangle it had in the frame before, of an even tile in the first one. The bits of the picture are those of one
/// process, for any split. Throws the run's error, on every rank.
void render_sort_first(compositor::Transport& transport, const SortFirstSettings& settings,
                       std::span<const VolumeJob> jobs, const scene::TransferFunction& function,
                       volume::Renderer& renderer, const scene::GridGeometry& geometry,
                       const std::function<void(FinishedVolumeFrame)>& done);

}  // namespace tessera::frame
