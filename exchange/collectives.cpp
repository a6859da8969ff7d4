#include <cstring>

#include "exchange/transport.hpp"

// All collectives pass through rank 0. A rank cannot begin the next one before rank 0 has everybody's part of this one,
// so messages of two collectives never mix although receive() takes from any rank.
namespace tessera::exchange {
namespace {

/// Lists of byte strings as one: count, then length and bytes each, 64-bit little endian.
Bytes join(const std::vector<Bytes>& parts) {
  Bytes joined;
  const auto number = [&](std::uint64_t value) {
    const auto* first = reinterpret_cast<const std::byte*>(&value);
    joined.insert(joined.end(), first, first + sizeof value);
  };
  number(parts.size());
  for (const Bytes& part : parts) {
    number(part.size());
    joined.insert(joined.end(), part.begin(), part.end());
  }
  return joined;
}

std::vector<Bytes> split(const Bytes& joined) {
  std::size_t at = 0;
  const auto number = [&] {
    std::uint64_t value = 0;
    std::memcpy(&value, joined.data() + at, sizeof value);
    at += sizeof value;
    return value;
  };
  std::vector<Bytes> parts(number());
  for (Bytes& part : parts) {
    const auto length = static_cast<std::ptrdiff_t>(number());
    const auto begin = joined.begin() + static_cast<std::ptrdiff_t>(at);
    part.assign(begin, begin + length);
    at += static_cast<std::size_t>(length);
  }
  return parts;
}

}  // namespace

Bytes broadcast(Transport& transport, int root, Bytes bytes) {
  const int self = transport.rank();
  if (self == 0) {
    if (root != 0) bytes = transport.receive(Channel::agreement).bytes;
    for (int rank = 1; rank < transport.size(); ++rank)
      if (rank != root) transport.send(rank, Channel::agreement, bytes);
    return bytes;
  }
  if (self != root) return transport.receive(Channel::agreement).bytes;
  transport.send(0, Channel::agreement, bytes);
  return bytes;
}

std::vector<Bytes> gather_all(Transport& transport, Bytes bytes) {
  const int self = transport.rank();
  if (self != 0) {
    transport.send(0, Channel::agreement, std::move(bytes));
    return split(transport.receive(Channel::agreement).bytes);
  }
  std::vector<Bytes> parts(static_cast<std::size_t>(transport.size()));
  parts[0] = std::move(bytes);
  for (int others = transport.size() - 1; others > 0; --others) {
    Message message = transport.receive(Channel::agreement);
    parts[static_cast<std::size_t>(message.from)] = std::move(message.bytes);
  }
  const Bytes joined = join(parts);
  for (int rank = 1; rank < transport.size(); ++rank) transport.send(rank, Channel::agreement, joined);
  return parts;
}

}  // namespace tessera::exchange
