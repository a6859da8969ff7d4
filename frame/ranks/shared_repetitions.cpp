// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/shared_repetitions.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "cells/duplicate_cells.hpp"
#include "exchange/message.hpp"

namespace tessera::frame {

std::uint64_t count_shared_repetitions(exchange::Transport& transport, std::vector<std::uint64_t> keys,
                                       std::span<const int> projectors) {
  constexpr std::size_t keys_a_message = std::size_t{1} << 21;
  constexpr int low_bits = 32;
  const std::size_t parts = projectors.size();
  std::vector<std::vector<std::uint64_t>> of_part(parts);
  for (const std::uint64_t key : keys) of_part[(key >> low_bits) * parts >> low_bits].push_back(key);
  keys = {};
  std::vector<std::uint64_t> own;
  for (std::size_t part = 0; part < parts; ++part) {
    std::span<const std::uint64_t> left = of_part[part];
    if (projectors[part] == transport.rank()) {
      own = std::move(of_part[part]);
      continue;
    }
    for (bool is_last = false; !is_last;) {
      const auto now = left.first(std::min(left.size(), keys_a_message));
      left = left.subspan(now.size());
      is_last = left.empty();
      exchange::Bytes message = exchange::message_of(exchange::MessageKind::cell_keys, std::uint8_t{is_last});
      exchange::append_list(message, now);
      transport.send(projectors[part], exchange::Channel::mesh, std::move(message));
    }
    of_part[part] = {};
  }
  for (std::uint64_t senders = parts - 1; senders > 0;) {
    const exchange::Message message = transport.receive(exchange::Channel::mesh);
    exchange::MessageReader reader(message.bytes, message.from, exchange::MessageKind::cell_keys);
    if (reader.take<std::uint8_t>() != 0) --senders;
    reader.take_onto(own, reader.take<std::uint64_t>());
    reader.finish();
  }
  return cells::count_repetitions(own);
}

}  // namespace tessera::frame
