#include "frame/reduce.hpp"

#include <fmt/format.h>

#include <cstring>

namespace tessera::frame {

using exchange::Bytes;
using exchange::Channel;

std::vector<std::uint64_t> reduce_all(exchange::Transport& transport, std::vector<std::uint64_t> values,
                                      Reduction reduction) {
  if (transport.size() == 1) return values;
  const std::size_t size = values.size() * sizeof(std::uint64_t);
  const auto bytes_of = [&] {
    const auto* first = reinterpret_cast<const std::byte*>(values.data());
    return Bytes(first, first + size);
  };
  const auto take = [&] {
    exchange::Message message = transport.receive(Channel::agreement);
    if (message.bytes.size() != size)
      throw scene::Error(
          scene::ErrorCode::system_failure,
          fmt::format("rank {} of {}: rank {} agrees on {} bytes, {} were awaited; all have to run one program",
                      transport.rank(), transport.size(), message.from, message.bytes.size(), size));
    return message.bytes;
  };
  // Through rank 0, as the other collectives, and for the reason that they give (collectives.cpp).
  if (transport.rank() != 0) {
    transport.send(0, Channel::agreement, bytes_of());
    const Bytes result = take();
    if (size > 0) std::memcpy(values.data(), result.data(), size);
    return values;
  }
  for (int others = transport.size() - 1; others > 0; --others) {
    const Bytes part = take();
    for (std::size_t k = 0; k < values.size(); ++k) {
      std::uint64_t value = 0;
      std::memcpy(&value, part.data() + k * sizeof value, sizeof value);
      values[k] = reduction == Reduction::sum ? values[k] + value : values[k] | value;
    }
  }
  for (int rank = 1; rank < transport.size(); ++rank) transport.send(rank, Channel::agreement, bytes_of());
  return values;
}

}  // namespace tessera::frame
