// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <utility>

#include "compositor/fragment_sink.hpp"
#include "compositor/picture_sink.hpp"

namespace tessera::compositor {

/// Sends the finished pixels of whole tiles, from a process that has all cells of these tiles. A tile's compositor
/// passes the pixels on unchanged. Each tile is one part of kind RecordKind::pixels; the pixels are those of
/// PictureSink.
template <class Encoding>
class PixelSink final : public FragmentSink<Encoding> {
 public:
  using typename FragmentSink<Encoding>::Deliver;
  using typename FragmentSink<Encoding>::Store;
  using typename FragmentSink<Encoding>::Depth;

  /// `packs(tile)` returns whether the tile's pixels should be packed, because they leave the process.
  PixelSink(const TileScene& scene, std::function<bool(std::size_t tile)> packs, Deliver deliver)
      : FragmentSink<Encoding>(exchange::RecordKind::pixels, std::move(deliver)),
        pixels_(scene, false),
        packs_(std::move(packs)) {}

  void begin_tile(std::size_t tile, const scene::PixelRect& rect) override;
  void start(const scene::PixelRect& rect) override;
  void take(Store& store, Depth final_depth, std::size_t at_least, scene::StageTimer& timer) override {
    segments_here_ += pixels_.take(store, final_depth, at_least, timer);
  }
  bool take_unordered(Store&, Depth, scene::StageTimer&) override { return false; }
  [[nodiscard]] const typename Encoding::Open& open() const override { return pixels_.open(); }
  [[nodiscard]] bool any_open() const override { return pixels_.any_open(); }
  void finish() override;
  void end_tile() override;

 private:
  using FragmentSink<Encoding>::writer_;
  using FragmentSink<Encoding>::segments_;

  TilePixels<Encoding> pixels_;
  std::function<bool(std::size_t tile)> packs_;
  std::size_t tile_ = 0;
  scene::PixelRect tile_rect_{0, 0, 0, 0}, rect_{0, 0, 0, 0};
  scene::Image image_;  ///< the pixels of the tile
  std::uint64_t segments_here_ = 0;
};

}  // namespace tessera::compositor
