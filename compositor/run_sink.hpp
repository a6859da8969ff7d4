// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "compositor/fragment_sink.hpp"
#include "compositor/tile_pixels.hpp"

namespace tessera::compositor {

/// Exchange::runs: segments of a pixel that touch end to end become one fragment. Cells never intersect, so no other
/// process has anything inside a run, and compositing it here is exact; a convex part of a mesh sends one fragment a
/// pixel whatever its number of cells.
///
/// Runs that carry neither light nor optical depth are not sent, and a run begins where it first becomes visible.
/// Pixels that this process's own cells make opaque are closed.
template <class Encoding>
class RunSink final : public FragmentSink<Encoding> {
 public:
  using typename FragmentSink<Encoding>::Deliver;
  using typename FragmentSink<Encoding>::Store;
  using typename FragmentSink<Encoding>::Depth;

  /// Runs are cut, and the tile's compositor told so, after `bytes_between_cuts` of records of a tile.
  RunSink(const TileScene& scene, std::uint64_t bytes_between_cuts, Deliver deliver);

  void begin_tile(std::size_t tile, const scene::PixelRect& rect) override;
  void start(const scene::PixelRect& rect) override;
  void take(Store& store, Depth final_depth, std::size_t at_least, scene::StageTimer& timer) override;
  /// Runs are then shorter, and no pixel of the rectangle closes any more, as what hides it may lie behind it.
  bool take_unordered(Store& store, Depth final_depth, scene::StageTimer& timer) override;
  [[nodiscard]] const typename Encoding::Open& open() const override { return pixels_.open(); }
  [[nodiscard]] bool any_open() const override { return pixels_.any_open(); }
  void finish() override;

 private:
  using FragmentSink<Encoding>::writer_;
  using FragmentSink<Encoding>::segments_;

  void cut(Depth final_depth);
  /// Writes the runs that have ended, in the encoding's records (exchange/wire.hpp), and forgets them.
  void write_ended();

  TileScene scene_;
  TilePixels<Encoding> pixels_;
  std::uint64_t bytes_between_cuts_, bytes_since_cut_ = 0;  ///< of the tile
};

}  // namespace tessera::compositor
