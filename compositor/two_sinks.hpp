#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include "compositor/tile_sink.hpp"

namespace tessera::compositor {

/// Gives a tile's segments to two sinks, neither of which takes them unordered. A pixel is open while either wants it.
class TwoSinks final : public TileSink {
 public:
  TwoSinks(std::unique_ptr<TileSink> a, std::unique_ptr<TileSink> b) : a_(std::move(a)), b_(std::move(b)) {}

  void begin_tile(std::size_t tile, const scene::PixelRect& rect) override {
    a_->begin_tile(tile, rect), b_->begin_tile(tile, rect);
  }
  void end_tile() override { a_->end_tile(), b_->end_tile(); }
  void start(const scene::PixelRect& rect) override { a_->start(rect), b_->start(rect); }
  void take(const projection::RaySegments& segments, const sorting::PixelLists& lists, double final_depth) override {
    a_->take(segments, lists, final_depth), b_->take(segments, lists, final_depth);
  }
  bool take_unordered(const projection::RaySegments&, const sorting::PixelLists&, double) override { return false; }
  [[nodiscard]] bool open(std::size_t pixel) const override { return a_->open(pixel) || b_->open(pixel); }
  [[nodiscard]] std::size_t open_count() const override { return std::max(a_->open_count(), b_->open_count()); }
  void finish() override { a_->finish(), b_->finish(); }

 private:
  std::unique_ptr<TileSink> a_, b_;
};

}  // namespace tessera::compositor
