#pragma once

#include "compositor/part_writer.hpp"
#include "compositor/tile_sink.hpp"

namespace tessera::compositor {

/// A sink that makes fragments for another process.
class FragmentSink : public TileSink, protected PartWriter {
 public:
  using PartWriter::Deliver;

  FragmentSink(RecordKind kind, Deliver deliver) : PartWriter(kind, std::move(deliver)) {}

  void begin_tile(std::size_t tile, const projection::PixelRect& rect) override { PartWriter::begin_tile(tile, rect); }
  void end_tile() override { PartWriter::end_tile(); }
  void start(const projection::PixelRect& rect) override { PartWriter::start(rect); }
};

}  // namespace tessera::compositor
