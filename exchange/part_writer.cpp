// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/part_writer.hpp"

#include <limits>
#include <utility>

namespace tessera::exchange {
namespace {

constexpr std::size_t part_bytes = 64 << 10;

}  // namespace

void PartWriter::begin_tile(std::size_t tile, const scene::PixelRect& rect) {
  tile_ = static_cast<std::uint32_t>(tile);
  tile_rect_ = rect;
  final_depth_ = -std::numeric_limits<double>::infinity();
  records_.clear();
  fragments_ = 0;
  ascents_ = 0;
  segments_ = false;
}

void PartWriter::end_tile() {
  final_depth_ = std::numeric_limits<double>::infinity();
  send(true);
}

std::uint32_t PartWriter::tile_pixel(std::size_t pixel) const {
  const int width = rect_.x1 - rect_.x0;
  const int x = rect_.x0 + static_cast<int>(pixel) % width, y = rect_.y0 + static_cast<int>(pixel) / width;
  return static_cast<std::uint32_t>((y - tile_rect_.y0) * (tile_rect_.x1 - tile_rect_.x0) + (x - tile_rect_.x0));
}

void PartWriter::complete_to(double depth) {
  // If the rectangle is only a part of the tile, its depth does not determine how complete the whole tile is.
  if (rect_.area() == tile_rect_.area()) final_depth_ = depth;
}

void PartWriter::send_if_full() {
  if (records_.size() >= part_bytes) send(false);
}

void PartWriter::send_rest() {
  if (!records_.empty()) send(false);
}

void PartWriter::send(bool last) {
  TilePart part{tile_, kind_, last, false, final_depth_, fragments_, std::exchange(records_, {})};
  part.ascending = ascents_ == 1;
  part.segments = segments_;
  fragments_ = 0;
  ascents_ = 0;
  segments_ = false;
  deliver_(std::move(part));
}

}  // namespace tessera::exchange
