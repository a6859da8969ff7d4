// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/reduce.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exchange/message.hpp"

namespace tessera::frame {

using exchange::Bytes;
using exchange::Channel;
using exchange::MessageKind;

std::vector<std::uint64_t> reduce_all(exchange::Transport& transport, std::vector<std::uint64_t> values,
                                      Reduction reduction) {
  if (transport.size() == 1) return values;
  const auto message = [&] {
    Bytes bytes = exchange::begin_message(MessageKind::reduction, (values.size() + 1) * sizeof(std::uint64_t));
    exchange::append_list(bytes, values);
    return bytes;
  };
  const auto take = [&] {
    const exchange::Message other = transport.receive(Channel::agreement);
    exchange::MessageReader reader(other, MessageKind::reduction);
    std::vector<std::uint64_t> list = reader.take_list<std::uint64_t>();
    if (list.size() != values.size()) reader.refuse(fmt::format("adds {} numbers to {}", list.size(), values.size()));
    return list;
  };
  // The values pass through rank 0, like in other collectives, for the reason in exchange/collectives.cpp.
  if (transport.rank() != 0) {
    transport.send(0, Channel::agreement, message());
    return take();
  }
  for (int others = transport.size() - 1; others > 0; --others) {
    const std::vector<std::uint64_t> part = take();
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = reduction == Reduction::sum      ? values[k] + part[k]
                  : reduction == Reduction::bit_or ? values[k] | part[k]
                                                   : std::min(values[k], part[k]);
  }
  const Bytes sum = message();
  for (int rank = 1; rank < transport.size(); ++rank) transport.send(rank, Channel::agreement, sum);
  return values;
}

}  // namespace tessera::frame
