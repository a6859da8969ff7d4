// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "compositor/fragment_sink.hpp"
#include "compositor/tile_pixels.hpp"

namespace tessera::compositor {

/// Implements Exchange::runs: segments of a pixel that touch end to end become one fragment. Cells never intersect, so
/// no other process has a segment inside a run, and compositing the run here is exact. A convex part of a mesh sends
/// one fragment per pixel, whatever its number of cells.
///
/// Runs that have neither light nor optical depth are not sent, and a run begins where it first becomes visible. Pixels
/// that become opaque by the cells of this process are closed.
template <class Encoding>
class RunSink final : public FragmentSink<Encoding> {
 public:
  using typename FragmentSink<Encoding>::Deliver;
  using typename FragmentSink<Encoding>::Store;
  using typename FragmentSink<Encoding>::Depth;

  /// Whenever the records of a tile have grown by `bytes_between_cuts`, runs are cut, so that this sink can report to
  /// the tile's compositor up to which depth the tile is complete.
  RunSink(const TileScene& scene, std::uint64_t bytes_between_cuts, Deliver deliver);

  void begin_tile(std::size_t tile, const scene::PixelRect& rect) override;
  void start(const scene::PixelRect& rect) override;
  void take(Store& store, Depth final_depth, std::size_t at_least, scene::StageTimer& timer) override;
  /// After this call, runs are shorter, and no pixel of the rectangle is closed: segments that make the pixel opaque
  /// may belong behind segments that come later.
  bool take_unordered(Store& store, Depth final_depth, scene::StageTimer& timer) override;
  [[nodiscard]] const typename Encoding::Open& open() const override { return pixels_.open(); }
  [[nodiscard]] bool any_open() const override { return pixels_.any_open(); }
  void finish() override;

 private:
  using FragmentSink<Encoding>::writer_;
  using FragmentSink<Encoding>::segments_;

  void cut(Depth final_depth);
  /// Writes the runs that have ended, as the encoding's records (exchange/wire.hpp), and removes them.
  void write_ended();

  TileScene scene_;
  TilePixels<Encoding> pixels_;
  std::uint64_t bytes_between_cuts_, bytes_since_cut_ = 0;  ///< bytes of the tile's records since the last cut
};

}  // namespace tessera::compositor
