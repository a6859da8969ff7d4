// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "exchange/wire.hpp"
#include "scene/pixel_rect.hpp"

namespace tessera::exchange {

/// Writes the parts of a tile for another process; used by all sinks that send fragments.
///
/// Parts are sent as soon as they are full, so the memory that a projector needs does not grow with the depth
/// complexity of a tile. Each part states the depth up to which the tile is complete, so that the compositor need not
/// store the whole tile either.
class PartWriter {
 public:
  using Deliver = std::function<void(TilePart)>;

  /// `deliver` receives the parts of a tile in order. It may block. It is called from the threads that use the writer.
  PartWriter(RecordKind kind, Deliver deliver) : kind_(kind), deliver_(std::move(deliver)) {}

  void begin_tile(std::size_t tile, const scene::PixelRect& rect);
  void end_tile();
  /// Starts a rectangle of the tile. From now on, pixel numbers refer to this rectangle.
  void start(const scene::PixelRect& rect) { rect_ = rect; }

  /// The buffer to which callers append records. They must also report the number of fragments to count().
  Bytes& records() { return records_; }
  void count(std::uint64_t fragments) { fragments_ += fragments; }
  /// begin_ascending(): the next records, or those just written, have ascending pixels, each pixel once.
  /// note_segments(): some of the records are single segments (PartHeader).
  void begin_ascending() { ++ascents_; }
  void note_segments() { segments_ = true; }

  /// Converts the number of a pixel in the current rectangle to its number in the tile.
  [[nodiscard]] std::uint32_t tile_pixel(std::size_t pixel) const;
  [[nodiscard]] const scene::PixelRect& rect() const { return rect_; }

  /// States that the records contain all of the rectangle's fragments before `depth`.
  void complete_to(double depth);
  /// Sends the records if there are enough for a message.
  void send_if_full();
  /// Sends the records if there are any, without ending the tile, which another writer continues.
  void send_rest();

 private:
  void send(bool last);

  RecordKind kind_;
  Deliver deliver_;
  std::uint32_t tile_ = 0;
  scene::PixelRect tile_rect_{0, 0, 0, 0}, rect_{0, 0, 0, 0};
  double final_depth_ = 0;
  std::uint64_t fragments_ = 0;
  int ascents_ = 0;
  bool segments_ = false;
  Bytes records_;
};

}  // namespace tessera::exchange
