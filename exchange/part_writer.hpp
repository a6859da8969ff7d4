// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "exchange/wire.hpp"
#include "scene/pixel_rect.hpp"

namespace tessera::exchange {

/// Writes the parts of a tile for another process: the common code of all sinks that send fragments.
///
/// Parts are sent as they fill, so a tile of any depth complexity takes a projector no memory. A part contains the
/// depth up to which the tile is complete, so that the compositor need not store all of it either.
class PartWriter {
 public:
  using Deliver = std::function<void(TilePart)>;

  /// `deliver` takes parts of a tile in order; it may block, and it is called from any thread that uses the writer.
  PartWriter(RecordKind kind, Deliver deliver) : kind_(kind), deliver_(std::move(deliver)) {}

  void begin_tile(std::size_t tile, const scene::PixelRect& rect);
  void end_tile();
  /// Starts a rectangle of the tile, to which pixel numbers refer from now on.
  void start(const scene::PixelRect& rect) { rect_ = rect; }

  /// Records are appended here; their fragments must be counted.
  Bytes& records() { return records_; }
  void count(std::uint64_t fragments) { fragments_ += fragments; }
  /// The next records, or those just written, are of ascending pixels, each once; note_segments(): some are single
  /// segments (PartHeader).
  void begin_ascending() { ++ascents_; }
  void note_segments() { segments_ = true; }

  /// Number within the tile of a pixel of the current rectangle.
  [[nodiscard]] std::uint32_t tile_pixel(std::size_t pixel) const;
  [[nodiscard]] const scene::PixelRect& rect() const { return rect_; }

  /// All of the rectangle's fragments before `depth` are in the records.
  void complete_to(double depth);
  /// Sends the records if there are enough for a message.
  void send_if_full();
  /// Sends the records, if any; another writer continues the tile.
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
