// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/collectives.hpp"

// All collectives pass through rank 0. No rank can begin the next collective before rank 0 has every rank's part of
// this one, so messages of two collectives never mix although receive() takes messages from any rank.
namespace tessera::exchange {
namespace {

Bytes joined(const std::vector<Bytes>& messages) {
  std::size_t room = sizeof(std::uint64_t);
  for (const Bytes& message : messages) room += sizeof(std::uint64_t) + message.size();
  Bytes all = begin_message(MessageKind::gathered, room);
  append(all, std::uint64_t{messages.size()});
  for (const Bytes& message : messages) append_list(all, message);
  return all;
}

std::vector<Bytes> split(const Message& joined, int ranks) {
  MessageReader reader(joined, MessageKind::gathered);
  if (reader.take<std::uint64_t>() != static_cast<std::uint64_t>(ranks)) reader.refuse_kind();
  std::vector<Bytes> messages;
  messages.reserve(static_cast<std::size_t>(ranks));
  for (int rank = 0; rank < ranks; ++rank) messages.push_back(reader.take_list<std::byte>());
  reader.finish();
  return messages;
}

}  // namespace

Bytes broadcast(Transport& transport, int root, Bytes message) {
  const int self = transport.rank();
  if (self == 0) {
    if (root != 0) message = transport.receive(Channel::agreement).bytes;
    for (int rank = 1; rank < transport.size(); ++rank)
      if (rank != root) transport.send(rank, Channel::agreement, message);
    return message;
  }
  if (self != root) return transport.receive(Channel::agreement).bytes;
  transport.send(0, Channel::agreement, message);
  return message;
}

std::vector<Bytes> gather_all(Transport& transport, Bytes message) {
  const int self = transport.rank();
  if (self != 0) {
    transport.send(0, Channel::agreement, std::move(message));
    return split(transport.receive(Channel::agreement), transport.size());
  }
  const MessageKind kind = MessageReader(message, self).kind();
  std::vector<Bytes> messages(static_cast<std::size_t>(transport.size()));
  messages[0] = std::move(message);
  for (int others = transport.size() - 1; others > 0; --others) {
    Message other = transport.receive(Channel::agreement);
    static_cast<void>(MessageReader(other, kind));
    messages[static_cast<std::size_t>(other.from)] = std::move(other.bytes);
  }
  const Bytes all = joined(messages);
  for (int rank = 1; rank < transport.size(); ++rank) transport.send(rank, Channel::agreement, all);
  return messages;
}

void barrier(Transport& transport) { gather_all(transport, begin_message(MessageKind::barrier)); }

}  // namespace tessera::exchange
