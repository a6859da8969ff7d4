#include "exchange/wire.hpp"

#include <fmt/format.h>

namespace tessera::exchange {

MessageHeader take_header(RecordReader& reader, int from, int self) {
  const auto header = reader.take<MessageHeader>();
  if (header.magic != wire_magic || header.version != wire_version)
    throw scene::Error(
        scene::ErrorCode::system_failure,
        fmt::format("exchange: rank {} speaks wire version {}, rank {} version {}; run one version of "
                    "the program on all machines",
                    from, header.magic == wire_magic ? fmt::to_string(header.version) : "unknown", self, wire_version));
  return header;
}

FrameEnd sum(const FrameEnd& a, const FrameEnd& b) {
  FrameEnd both{a.counters, a.on_lattice + b.on_lattice, a.failed_devices + b.failed_devices, a.stopped + b.stopped};
  both.counters += b.counters;
  return both;
}

}  // namespace tessera::exchange
