// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frame/mesh/tile_renderer.hpp"
#include "integrals/segment_batch.hpp"
#include "projection/face_marks.hpp"
#include "projection/scanline/scanline_rasterizer.hpp"
#include "sorting/encodings.hpp"

namespace tessera::frame {

/// A tile renderer's source in double precision, for any frame. It uses the `planes` or the `scanline` rasterizer.
/// Cells are cut at steps of the transfer function where necessary. Where rays cross triangle surfaces, all cells are
/// cut there; the crossings of these surfaces are in the store from the beginning. The store is one buffer for all
/// pixels.
///
/// AttributeSegments require the `planes` rasterizer and a frame without triangle surfaces.
template <class Segments>
class DoubleSourceOf {
 public:
  using Encoding = sorting::DoubleEncodingOf<Segments>;
  using Store = typename Encoding::Store;

  DoubleSourceOf(const TileContext& context, TileCounts& counts) : context_(context), counts_(&counts) {}

  bool start(const scene::PixelRect& rect, const projection::DepthOrder& order);
  bool fill(const compositor::TileSink<Encoding>& sink);
  [[nodiscard]] double final_depth() const;
  [[nodiscard]] std::size_t at_least() const { return 1; }
  bool make_room();
  Store& store() { return lists_; }
  [[nodiscard]] std::size_t capacity() const { return lists_.segments.capacity(); }
  [[nodiscard]] std::size_t alive() const { return lists_.segments.size; }

  /// Bytes that one segment takes in all buffers of a renderer and its sink.
  static constexpr std::size_t bytes_a_segment = Store::bytes_each + integrals::SegmentBatch::bytes_each;

 private:
  bool reserve(std::size_t segments);
  std::size_t rasterize(std::span<const projection::TileEntry> entries);
  std::size_t rasterize_at_steps(std::span<const projection::TileEntry> entries);
  std::size_t rasterize_at_faces(std::span<const projection::TileEntry> entries);

  TileContext context_;
  TileCounts* counts_;
  scene::PixelRect rect_{0, 0, 0, 0};
  const projection::DepthOrder* order_ = nullptr;
  std::size_t next_ = 0;  ///< index of the next cell in `order_`
  std::size_t most_ = 0;  ///< upper bound of the segments that a cell may add
  projection::ScanlineBuffers scanline_;
  projection::SplitRasterizer<Segments> splitter_;
  projection::FaceMarks marks_;
  Store lists_;
};

using DoubleSource = DoubleSourceOf<projection::RaySegments>;

}  // namespace tessera::frame
