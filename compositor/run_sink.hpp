// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "compositor/fragment_sink.hpp"
#include "compositor/tile_pixels.hpp"

namespace tessera::compositor {

/// Exchange::runs: segments of a pixel that touch end to end become one fragment. Cells never intersect, so no other
/// process has a segment inside a run, and compositing it here is exact. A convex part of a mesh sends one fragment per
/// pixel, whatever its number of cells.
///
/// Runs without light and optical depth are not sent, and a run begins where it first becomes visible. Pixels that this
/// process's own cells make opaque are closed.
template <class Encoding>
class RunSink final : public FragmentSink<Encoding> {
 public:
  using typename FragmentSink<Encoding>::Deliver;
  using typename FragmentSink<Encoding>::Store;
  using typename FragmentSink<Encoding>::Depth;

  /// After `bytes_between_cuts` of a tile's records, runs are cut, so that the tile's compositor can be informed how
  /// far the tile is complete.
  RunSink(const TileScene& scene, std::uint64_t bytes_between_cuts, Deliver deliver);

  void begin_tile(std::size_t tile, const scene::PixelRect& rect) override;
  void start(const scene::PixelRect& rect) override;
  void take(Store& store, Depth final_depth, std::size_t at_least, scene::StageTimer& timer) override;
  /// Runs become shorter, and no pixel of the rectangle is closed any longer, because the segments that hide it may be
  /// behind later ones.
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
  std::uint64_t bytes_between_cuts_, bytes_since_cut_ = 0;  ///< of the tile
};

}  // namespace tessera::compositor
