// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/message.hpp"

#include <fmt/format.h>

#include "scene/error.hpp"

namespace tessera::exchange {

// This is not inline, and does not use append(), because GCC 12 reports an overflow when a vector of known size grows.
Bytes begin_message(MessageKind kind, std::size_t room) {
  Bytes message;
  message.reserve(sizeof(MessageHeader) + room);
  message.resize(sizeof(MessageHeader));
  const MessageHeader header{.kind = kind};
  std::memcpy(message.data(), &header, sizeof header);
  return message;
}

void RecordReader::refuse(std::string_view what) const {
  throw scene::Error(scene::ErrorCode::system_failure,
                     fmt::format("exchange: a message{} {}; all ranks must run the same program",
                                 from_ < 0 ? "" : fmt::format(" from rank {}", from_), what));
}

void RecordReader::refuse_short() const { refuse("is shorter than it states"); }

MessageReader::MessageReader(std::span<const std::byte> message, int from) : RecordReader(message, from) {
  const auto header = take<MessageHeader>();
  if (header.magic != wire_magic) refuse("has an unknown wire version");
  if (header.version != wire_version)
    refuse(fmt::format("has wire version {}, but this rank uses version {}", header.version, wire_version));
  kind_ = header.kind;
}

MessageReader::MessageReader(std::span<const std::byte> message, int from, MessageKind awaited)
    : MessageReader(message, from) {
  if (kind_ != awaited)
    refuse(fmt::format("is of kind {}, but kind {} was expected", static_cast<int>(kind_), static_cast<int>(awaited)));
}

void MessageReader::refuse_kind() const {
  refuse(fmt::format("is of kind {}, which is not expected here", static_cast<int>(kind_)));
}

}  // namespace tessera::exchange
