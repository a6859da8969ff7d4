// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "compositor/tile_sink.hpp"
#include "exchange/part_writer.hpp"

namespace tessera::compositor {

/// A sink that makes fragments for another process.
template <class Encoding>
class FragmentSink : public TileSink<Encoding> {
 public:
  using Deliver = exchange::PartWriter::Deliver;

  void begin_tile(std::size_t tile, const scene::PixelRect& rect) override { writer_.begin_tile(tile, rect); }
  void end_tile() override { writer_.end_tile(); }
  void start(const scene::PixelRect& rect) override { writer_.start(rect); }
  [[nodiscard]] std::uint64_t segments() const final { return segments_; }

 protected:
  FragmentSink(exchange::RecordKind kind, Deliver deliver) : writer_(kind, std::move(deliver)) {}

  exchange::PartWriter writer_;
  std::uint64_t segments_ = 0;
};

}  // namespace tessera::compositor
