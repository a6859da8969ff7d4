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

/// A session's settings, and what differs between its processes and data sets. `memory_bytes` is the budget of the
/// bricks in memory.
struct RenderSettings : Settings {
  std::vector<scene::HalfSpace> clip{};  ///< that rays are kept in (tessera/selection.hpp)
  int parts = 1;  ///< that rays are composited of, each by one process: all of them together have the accuracy asked
};

/// Whether rays are sampled in steps of GridSettings::step; else they go from voxel to voxel.
inline bool in_steps(IntegratorKind kind) {
  return kind == IntegratorKind::sampled || kind == IntegratorKind::preintegrated;
}

/// What happened in one frame.
struct RenderStatistics : GridCounters {
  std::string instruction_set;  ///< of the kernels that ran
};

/// Regions that begin and end at multiples of this many pixels share no work with their neighbours.
inline constexpr int region_grain = 4;

/// What of an image is cast, and what is kept in addition to it.
struct CastRequest {
  /// No two share a tile; by default the whole image.
  std::vector<scene::PixelRect> regions{{0, 0, std::numeric_limits<int>::max(), std::numeric_limits<int>::max()}};
  /// Sort-last: the light of a part of the volume, as if the rest of it were empty. The regions hold all that it may
  /// cover (footprint() in cost_map.hpp). Images of parts that make up the volume, composited front to back, are the
  /// image to rounding. Bricks that hold voxels of the part are read, no others. IntegratorKind::preintegrated would
  /// miss steps from one part to the next.
  std::optional<VoxelBox> part{};
  bool error_bounds = false, tile_times = false;
};

/// A frame of a volume.
struct Frame {
  scene::Image image;  ///< of pixels outside of the regions nothing
  RenderStatistics statistics;
  /// If asked for: by pixel, what float lanes may err there in linear RGBA, so far as they add it up
  /// (lane_error_bound.hpp); above half the accuracy asked a pixel was cast again in double precision. Zero where no
  /// ray was cast, and all over rectilinear grids.
  std::vector<float> error_bounds;
  std::vector<TileTime> tile_times;  ///< if asked for; none of rectilinear grids
};

/// A pilot pass: of the tiles of a region (none: the image) one in `turns` is cast, another with each `number`.
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

/// Casts rays through one volume many times, in one process, by the ranges of values in its cells, by which empty space
/// is skipped (cell_ranges.hpp). The source must outlive the renderer.
///
/// Bits   on one instruction set the image is the same for any brick size, memory budget, cache policy, thread count
///        and region.
class Renderer {
 public:
  /// Of settings that are valid for grids (tessera::validate), and for this one: not in steps if it is rectilinear,
  /// iso-surfaces of point data alone. Takes ranges that have been found before, of this very source.
  Renderer(const scene::SampleSource& source, const RenderSettings& settings, CellRanges ranges);
  /// The same, of ranges that others use too.
  Renderer(const scene::SampleSource& source, const RenderSettings& settings, std::shared_ptr<const CellRanges> ranges);
  /// Reads all samples once, for their ranges.
  Renderer(const scene::SampleSource& source, const RenderSettings& settings);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Throws Error(bad_input) for an invalid camera or size; Error(system_failure) if the budget does not hold the
  /// bricks that the threads need at one time. `watch` is called with finished tiles of the regions; once it is asked
  /// to stop, render() throws scene::FrameStopped within a tile of rays, and can be called again.
  Frame render(const scene::Camera& camera, scene::ImageSize size, const scene::TransferFunction& transfer_function,
               const CastRequest& request = {}, scene::FrameWatch* watch = nullptr);

  /// The pilot pass: casts every 32nd ray of the image (more of a small one), and counts where in the volume the work
  /// was (learned_work.hpp); makes no light. As render() otherwise.
  void sample_work(const scene::Camera& camera, scene::ImageSize size, const scene::TransferFunction& transfer_function,
                   WorkTally& tally, const PilotPass& pass = {}, scene::FrameWatch* watch = nullptr);

  /// What each pixel will cost, for the split of the image between processes (cost_map.hpp): from the cells of 8^3
  /// voxels, or the bricks, that the transfer function shows. What this renderer knows of `settings` (voxels or
  /// lengths, the length unit, where rays end) is its own.
  [[nodiscard]] CostMap cost_map(const scene::Camera& camera, scene::ImageSize size,
                                 const scene::TransferFunction& transfer_function, CostSettings settings) const;

  /// The volume cut into boxes for `processes`, for this transfer function (object_split.hpp).
  [[nodiscard]] ObjectSplit object_split(const scene::TransferFunction& transfer_function, int processes) const;

  /// Of the whole volume, blank samples left out.
  [[nodiscard]] scene::ValueRange range() const;
  [[nodiscard]] const scene::GridGeometry& geometry() const;

  /// Corners, in index space, of the bricks that the transfer function shows anything of.
  [[nodiscard]] std::vector<std::array<glm::dvec3, 2>> visible_bricks(
      const scene::TransferFunction& transfer_function) const;

 private:
  friend class ChunkCast;

  std::unique_ptr<RendererState> state_;
};

}  // namespace tessera::volume
