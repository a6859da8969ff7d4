// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frame/mesh/tile_renderer.hpp"
#include "projection/lattice/lattice_rasterizer.hpp"
#include "sorting/encodings.hpp"

namespace tessera::frame {

/// A tile renderer's source on the integer lattice, for frames that have a lattice (frame/mesh/lattice_frame.hpp). It
/// rasterizes sixteen cells at once and moves their segments to the windows of the pixels.
///
/// A window holds a few dozen segments of one pixel. The store is full when one window is full.
class LatticeSource {
 public:
  using Encoding = sorting::LatticeEncoding;

  LatticeSource(const TileContext& context, TileCounts& counts, const projection::LatticeView& view);

  bool start(const scene::PixelRect& rect, const projection::DepthOrder& order);
  bool fill(const compositor::TileSink<Encoding>& sink);
  [[nodiscard]] std::int64_t final_depth() const;
  [[nodiscard]] std::size_t at_least() const { return at_least_; }
  bool make_room();
  projection::SegmentWindows& store() { return windows_; }
  [[nodiscard]] std::size_t capacity() const { return windows_.capacity(); }
  [[nodiscard]] std::uint64_t alive() const { return windows_.total(); }

 private:
  [[nodiscard]] std::int64_t first_of_marks() const;
  [[nodiscard]] std::int64_t first_of_cells() const;

  TileContext context_;
  TileCounts* counts_;
  projection::LatticeView view_;
  std::size_t first_capacity_, at_least_;
  scene::PixelRect rect_{0, 0, 0, 0};
  const projection::DepthOrder* order_ = nullptr;
  std::size_t cells_ = 0;   ///< number of rasterized cells, including those whose segments are still in `stream_`
  std::size_t from_ = 0;    ///< index of the first cell whose segments are in `stream_`
  std::size_t placed_ = 0;  ///< number of segments of `stream_` that are already in the windows
  projection::LatticeScratch scratch_;
  projection::FaceMarks marks_;
  projection::LatticeFaces faces_;
  projection::SegmentStream stream_;
  projection::SegmentWindows windows_;
};

}  // namespace tessera::frame
