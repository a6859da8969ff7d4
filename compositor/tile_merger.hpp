// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "exchange/wire.hpp"
#include "integrals/lane_table.hpp"
#include "integrals/segment_integrator.hpp"
#include "projection/footprint.hpp"
#include "projection/matter_light.hpp"
#include "projection/pixel_space.hpp"
#include "scene/deep_image.hpp"
#include "scene/image.hpp"
#include "scene/lattice.hpp"
#include "scene/surface_set.hpp"
#include "scene/transfer_function.hpp"
#include "tessera/settings.hpp"

namespace tessera::compositor {

class GlCompositor;

/// What a compositor's mergers need to know about a frame. All of it must outlive the mergers.
struct MergeContext {
  const projection::PixelSpace* space;
  const integrals::SegmentIntegrator* integrator;
  double max_color, longest_ray;
  float longest_edge;  ///< tuples: unit of their lengths
  scene::Emission emission;
  std::uint64_t budget_bytes;  ///< memory for the fragments of one tile that cannot be composited yet
  /// For deep samples and layers: the transfer function, on the lattice if there is one.
  const scene::TransferFunction* function = nullptr;
  double deep_accuracy = 0;    ///< > 0: the merger also makes deep samples from segments (deep_sink.hpp)
  std::optional<Peel> peel{};  ///< if set, the deep samples are layers (peel_sink.hpp)
  // For lattice segments:
  const scene::Lattice* lattice = nullptr;
  const integrals::LaneTable* table = nullptr;  ///< table on that lattice
  scene::Trace* trace = nullptr;
  // For a device (gl_merger.hpp). It needs `table` and `lattice` also for frames that are not on the lattice:
  GlCompositor* device = nullptr;
  bool on_lattice = true;  ///< false: `lattice` contains device_units()
  std::uint32_t frame = 0;
  /// If not null, the CPU takes over when the device fails, and the flag is set to true.
  std::atomic<bool>* device_failed = nullptr;
  /// Counts the segments that the device makes from cells; may be null.
  std::atomic<std::uint64_t>* segments = nullptr;
  /// Set to true if runs of a pixel overlap, because they then have no correct order; may be null.
  std::atomic<bool>* overlapping = nullptr;
  const scene::SurfaceSet* surfaces = nullptr;  ///< surfaces inside the volume; null: none
  /// Lighting of the matter of a mesh, computed by the CPU; null: none.
  const projection::MatterLight* light = nullptr;

  /// An upper bound of the light that a ray can still collect while its transmittance is 1
  /// (integrals::opacity_weight()).
  [[nodiscard]] double opacity_weight() const {
    const double brightest = light != nullptr ? light->brightest(max_color) : max_color;
    const double weight = integrals::opacity_weight(brightest, longest_ray, emission);
    return surfaces != nullptr ? std::max(weight, surfaces->max_color()) : weight;
  }
};

/// A finished tile.
struct MergedTile {
  scene::Image image;  ///< its pixel (0, 0) is the first pixel of the tile
  /// Deep samples, row by row: the number of samples of each pixel, and all samples. Empty if not requested.
  std::vector<std::uint32_t> deep_counts;
  std::vector<scene::DeepImageSample> deep_samples;
  /// If not empty, replaces `image`: the tile's pixels as bytes (exchange/packed_pixels.hpp).
  exchange::Bytes pixels{};
};

/// Computes one tile of the image from the fragments of all projectors.
///
/// Parts may arrive in any order. The image does not depend on this order because fragments have a total order:
/// segments by (front, back, tet), runs by all their fields. A merger may be used by only one thread at a time.
class TileMerger {
 public:
  virtual ~TileMerger() = default;

  /// Takes the records of a part. Throws Error(system_failure) if the part is malformed, or if the tile needs more
  /// memory than the budget.
  virtual void add(const exchange::TilePart& part) = 0;

  /// Composites all fragments before this planar depth; all of these fragments must have been added.
  virtual void advance(double final_depth) = 0;

  /// Returns the tile. Must be called after advance(infinity).
  virtual MergedTile finish() = 0;
};

/// Adds parts, which must be sorted by `start_depth`, and advances the merger to `final_depth`. This is done in steps
/// that stay well within a merger's budget (in memory, a segment takes five times its bytes in the message).
void merge(TileMerger& merger, const std::vector<exchange::TilePart>& parts, double final_depth,
           std::uint64_t budget_bytes);

/// Makes a merger for parts of this kind.
std::unique_ptr<TileMerger> make_tile_merger(exchange::RecordKind kind, const MergeContext& context,
                                             const scene::PixelRect& rect);

}  // namespace tessera::compositor
