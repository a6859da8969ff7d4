#pragma once

#include "compositor/tile_sink.hpp"
#include "exchange/part_writer.hpp"

namespace tessera::compositor {

/// A sink that makes fragments for another process.
class FragmentSink : public TileSink, protected exchange::PartWriter {
 public:
  using exchange::PartWriter::Deliver;

  FragmentSink(exchange::RecordKind kind, Deliver deliver) : exchange::PartWriter(kind, std::move(deliver)) {}

  void begin_tile(std::size_t tile, const scene::PixelRect& rect) override {
    exchange::PartWriter::begin_tile(tile, rect);
  }
  void end_tile() override { exchange::PartWriter::end_tile(); }
  void start(const scene::PixelRect& rect) override { exchange::PartWriter::start(rect); }
};

}  // namespace tessera::compositor
