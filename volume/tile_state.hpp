// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "scene/pixel_rect.hpp"
#include "volume/fragment_sink.hpp"
#include "volume/frame_view.hpp"
#include "volume/lane_error_bound.hpp"
#include "volume/split/voxel_box.hpp"
#include "volume/tile_rays.hpp"

namespace tessera::volume {

/// The rays of one tile between chunks: their positions, progress and accumulated light.
///
/// begin() initializes them. cast_tile() (tile_caster.hpp) casts them through one chunk, and may be called repeatedly
/// for chunks from front to back. Between calls, rays can be queried and closed. fragments() returns the accumulated
/// light. Only one thread may use a tile at a time.
///
/// Axes      Rays of one tile may have several main axes (TileRays): there is a TileRays for each axis code, and every
///           ray is in one of them.
/// Memory    150 KB for each TileRays; usually there is one. begin() reuses the memory.
class TileState {
 public:
  /// Starts the tile whose first pixel is (x0, y0), which are multiples of 32; only its pixels in `region` are cast. A
  /// pilot pass (FrameView::tally) casts a few packets.
  void begin(const FrameView& frame, int x0, int y0, const scene::PixelRect& region, TileCounts& counts);

  /// Sets TileRays::from and to of the rays of one axis code to the parts of the rays in a chunk. Returns false if no
  /// ray has a part in the chunk.
  bool enter(const FrameView& frame, const VoxelBox& chunk, int code);

  /// Whether light may still be added to the ray of a pixel: it has not left the volume, is not opaque and has not been
  /// closed.
  [[nodiscard]] bool open(const FrameView& frame, int x, int y) const;
  [[nodiscard]] bool any_open(const FrameView& frame) const;
  /// Transmittance of the part of a pixel's ray that has been cast.
  [[nodiscard]] float transmittance(int x, int y) const;
  /// Ends this pixel's ray; the light that it has accumulated is kept.
  void close(int x, int y);

  /// Appends the light of the rays since begin() or restart() to `certain`, in the order of pixels. Rays whose light in
  /// float lanes is uncertain are appended to `uncertain`.
  void fragments(const FrameView& frame, std::vector<RayFragment>& certain, std::vector<UncertainRay>& uncertain) const;
  /// Continues the rays without light: the light that follows will be a separate fragment.
  void restart();

  [[nodiscard]] unsigned codes() const { return codes_; }
  [[nodiscard]] TileRays& rays(int code) { return *rays_[static_cast<std::size_t>(code)]; }
  /// The packets with pixels to be cast, one bit each.
  [[nodiscard]] std::uint64_t wanted() const { return wanted_; }
  /// The pixels to be cast.
  [[nodiscard]] scene::PixelRect pixels() const;

 private:
  /// Calls f(rays, ray) with the TileRays that contains a pixel's ray.
  template <class F>
  void with_ray(int x, int y, const F& f) const;

  int x0_ = 0, y0_ = 0;
  scene::PixelRect region_{};
  std::uint64_t wanted_ = 0;
  unsigned codes_ = 0;  ///< bit n: there are rays of axis code n
  std::array<std::unique_ptr<TileRays>, RayAxes::codes> rays_;
};

}  // namespace tessera::volume
