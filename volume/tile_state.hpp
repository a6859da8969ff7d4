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

/// The rays of one tile from chunk to chunk: where they are, how far they have come and what they have gathered.
///
/// begin() makes them ready, cast_tile() (tile_caster.hpp) takes them through one chunk and can be called again with
/// the next one behind it, in between rays may be asked for and closed, and fragments() says what they have gathered.
/// A tile is one thread's at a time.
///
/// Axes     rays of one tile may have several (TileRays): there is a TileRays for each, and a ray is in one of them.
/// Memory   150 KB for each of these, mostly one. begin() uses it again.
class TileState {
 public:
  /// The tile whose first pixel is (x0, y0), multiples of 32; of its pixels those in `region` count. A pilot pass
  /// (FrameView::tally) casts a few packets.
  void begin(const FrameView& frame, int x0, int y0, const scene::PixelRect& region, TileCounts& counts);

  /// Sets TileRays::from and to of the rays of one axis code: their parts in a chunk. False if none has one.
  bool enter(const FrameView& frame, const VoxelBox& chunk, int code);

  /// Whether something may be added to the ray of a pixel: it meets the volume behind what has been cast, lets light
  /// through and has not been closed.
  [[nodiscard]] bool open(const FrameView& frame, int x, int y) const;
  [[nodiscard]] bool any_open(const FrameView& frame) const;
  /// What gets through all that a pixel's ray has met.
  [[nodiscard]] float transmittance(int x, int y) const;
  /// Nothing more is added to this pixel's ray; what it has stays.
  void close(int x, int y);

  /// What the rays have gathered since begin() or restart(), in the order of pixels; those that float lanes are not
  /// sure of go to `uncertain` instead. Both lists are appended to.
  void fragments(const FrameView& frame, std::vector<RayFragment>& certain, std::vector<UncertainRay>& uncertain) const;
  /// The rays go on where they are, without light: what they gather from here on is a fragment of its own.
  void restart();

  [[nodiscard]] unsigned codes() const { return codes_; }
  [[nodiscard]] TileRays& rays(int code) { return *rays_[static_cast<std::size_t>(code)]; }
  /// The packets with pixels that count, a bit each.
  [[nodiscard]] std::uint64_t wanted() const { return wanted_; }
  /// The pixels that count.
  [[nodiscard]] scene::PixelRect pixels() const;

 private:
  /// Calls f(rays, ray) for each place where a pixel's ray may be: once with the right one.
  template <class F>
  void with_ray(int x, int y, const F& f) const;

  int x0_ = 0, y0_ = 0;
  scene::PixelRect region_{};
  std::uint64_t wanted_ = 0;
  unsigned codes_ = 0;  ///< bit n: rays of axis code n
  std::array<std::unique_ptr<TileRays>, RayAxes::codes> rays_;
};

}  // namespace tessera::volume
