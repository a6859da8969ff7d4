#pragma once

#include <functional>

#include "compositor/tile_sink.hpp"
#include "compositor/wire.hpp"

namespace tessera::compositor {

/// A sink that makes fragments for another process: what its kinds have in common.
///
/// Parts leave as they fill, so a tile of any depth complexity costs a projector no memory. A part says up to which
/// depth the tile is complete, so that the compositor need not hold all of it either.
class FragmentSink : public TileSink {
 public:
  using Deliver = std::function<void(TilePart)>;

  /// `deliver` takes parts of a tile in order; it may block, and it may be called from any thread that uses the sink.
  FragmentSink(RecordKind kind, Deliver deliver) : kind_(kind), deliver_(std::move(deliver)) {}

  void begin_tile(std::size_t tile, const projection::PixelRect& rect) override;
  void end_tile() override;
  void start(const projection::PixelRect& rect) override;

 protected:
  /// Room for the records; fragments are to be counted.
  Bytes& records() { return records_; }
  void count(std::uint64_t fragments) { fragments_ += fragments; }

  /// Number within the tile of a pixel of the current rectangle.
  [[nodiscard]] std::uint32_t tile_pixel(std::size_t pixel) const;
  [[nodiscard]] const projection::PixelRect& rect() const { return rect_; }

  /// All of the rectangle's fragments before `depth` are in the records.
  void complete_to(double depth);
  /// Sends what there is if that is worth a message.
  void send_if_full();

 private:
  void send(bool last);

  RecordKind kind_;
  Deliver deliver_;
  std::uint32_t tile_ = 0;
  projection::PixelRect tile_rect_{0, 0, 0, 0}, rect_{0, 0, 0, 0};
  double final_depth_ = 0;
  std::uint64_t fragments_ = 0;
  Bytes records_;
};

}  // namespace tessera::compositor
