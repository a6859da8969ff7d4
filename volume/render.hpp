// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "scene/frame_watch.hpp"
#include "scene/image.hpp"
#include "scene/pixel_rect.hpp"
#include "scene/sample_source.hpp"
#include "scene/selection.hpp"
#include "scene/transfer_function.hpp"
#include "tessera/settings.hpp"
#include "tessera/statistics.hpp"
#include "volume/split/tile_costs.hpp"
#include "volume/split/voxel_box.hpp"

namespace tessera::volume {

/// The settings of a session, together with those that differ between its processes and data sets. `memory_bytes` is
/// the budget for bricks in memory.
struct RenderSettings : Settings {
  std::vector<scene::HalfSpace> clip{};  ///< half-spaces to which rays are clipped (tessera/selection.hpp)
  /// Number of processes that each cast a part of a ray; all parts together have the requested accuracy.
  int parts = 1;
};

/// Whether rays are sampled in steps of GridSettings::step; otherwise they go from voxel to voxel.
inline bool in_steps(IntegratorKind kind) {
  return kind == IntegratorKind::sampled || kind == IntegratorKind::preintegrated;
}

/// Statistics of one frame.
struct RenderStatistics : GridCounters {
  std::string instruction_set;  ///< instruction set of the kernels that ran
};

/// Regions whose bounds are multiples of this many pixels share no work with neighbouring regions.
inline constexpr int region_grain = 4;

/// The part of the image to cast, and the additional results to return.
struct CastRequest {
  /// No two regions may share a tile. Default: the whole image.
  std::vector<scene::PixelRect> regions{{0, 0, std::numeric_limits<int>::max(), std::numeric_limits<int>::max()}};
  /// Sort-last: casts only this part of the volume, as if the rest were empty. The regions must contain all pixels that
  /// it may cover (footprint() in cost_map.hpp). Images of parts that make up the volume, composited front to back,
  /// equal the image up to rounding. Only bricks with voxels of the part are read. IntegratorKind::preintegrated would
  /// miss steps from one part to the next.
  std::optional<VoxelBox> part{};
  bool error_bounds = false, tile_times = false;
};

/// A rendered frame of a volume.
struct Frame {
  scene::Image image;  ///< empty outside the regions
  RenderStatistics statistics;
  /// If requested: for each pixel, the recorded error bound of float lanes in linear RGBA (lane_error_bound.hpp).
  /// Pixels whose bound was above half the requested accuracy, divided by the number of parts, were cast again in
  /// double precision. Zero where no ray was cast, and for rectilinear grids.
  std::vector<float> error_bounds;
  std::vector<TileTime> tile_times;  ///< if requested; empty for rectilinear grids
};

/// A pilot pass casts one of every `turns` tiles of a region (default: the image); different values of `number` select
/// different tiles.
struct PilotPass {
  std::optional<scene::PixelRect> region{};
  std::size_t number = 0, turns = 1;
};

struct CellRanges;
struct CostMap;
struct CostSettings;
struct RendererState;
class WorkTally;
class ObjectSplit;

/// Renders one volume repeatedly, in one process, by ray casting. The value ranges of its cells are used to skip empty
/// space (cell_ranges.hpp). The source must outlive the renderer.
///
/// Bits      On one instruction set the image is the same for any brick size, memory budget, cache policy, number of
///           threads and region.
class Renderer {
 public:
  /// The settings must be valid for grids (tessera::validate) and for this grid: no integrators with steps for
  /// rectilinear grids, iso-surfaces for point data only. `ranges` must have been computed from the same source.
  Renderer(const scene::SampleSource& source, const RenderSettings& settings, CellRanges ranges);
  /// Uses ranges that are shared with other objects.
  Renderer(const scene::SampleSource& source, const RenderSettings& settings, std::shared_ptr<const CellRanges> ranges);
  /// Reads all samples once to compute their ranges.
  Renderer(const scene::SampleSource& source, const RenderSettings& settings);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Renders a frame. Throws Error(bad_input) for an invalid camera or size, and Error(system_failure) if the budget
  /// cannot hold the bricks that the threads need at the same time. `watch` is called with finished tiles of the
  /// regions. After a stop request, render() throws scene::FrameStopped within a tile of rays; it can be called again
  /// afterwards.
  Frame render(const scene::Camera& camera, scene::ImageSize size, const scene::TransferFunction& transfer_function,
               const CastRequest& request = {}, scene::FrameWatch* watch = nullptr);

  /// Casts a pilot pass: every 32nd ray of the image (more rays of small images). Counts the work by position in the
  /// volume (learned_work.hpp) without producing light. Otherwise like render().
  void sample_work(const scene::Camera& camera, scene::ImageSize size, const scene::TransferFunction& transfer_function,
                   WorkTally& tally, const PilotPass& pass = {}, scene::FrameWatch* watch = nullptr);

  /// The estimated cost of each pixel, used to split the image between processes (cost_map.hpp): from the cells of 8^3
  /// voxels, or the bricks, that are visible under the transfer function. The renderer overrides the members of
  /// `settings` that depend on it: voxels or lengths, the length unit, and the depth at which rays end.
  [[nodiscard]] CostMap cost_map(const scene::Camera& camera, scene::ImageSize size,
                                 const scene::TransferFunction& transfer_function, CostSettings settings) const;

  /// Splits the volume into boxes for `processes` processes, for this transfer function (object_split.hpp).
  [[nodiscard]] ObjectSplit object_split(const scene::TransferFunction& transfer_function, int processes) const;

  /// The value range of the whole volume without blank samples.
  [[nodiscard]] scene::ValueRange range() const;
  [[nodiscard]] const scene::GridGeometry& geometry() const;

  /// Corners, in index space, of the bricks that are visible under the transfer function.
  [[nodiscard]] std::vector<std::array<glm::dvec3, 2>> visible_bricks(
      const scene::TransferFunction& transfer_function) const;

 private:
  friend class ChunkCast;

  std::unique_ptr<RendererState> state_;
};

}  // namespace tessera::volume
