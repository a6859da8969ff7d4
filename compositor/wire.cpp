#include "compositor/wire.hpp"

#include <fmt/format.h>

namespace tessera::compositor {

MessageHeader take_header(RecordReader& reader, int from, int self) {
  const auto header = reader.take<MessageHeader>();
  if (header.magic != wire_magic || header.version != wire_version)
    throw scene::Error(
        scene::ExitCode::system_failure,
        fmt::format("exchange: rank {} speaks wire version {}, rank {} version {}; run one version of "
                    "the program on all machines",
                    from, header.magic == wire_magic ? fmt::to_string(header.version) : "unknown", self, wire_version));
  return header;
}

}  // namespace tessera::compositor
