// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/run_faults.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdint>

namespace tessera::exchange {

Bytes error_message(MessageKind kind, const scene::Error& error) {
  Bytes message = message_of(kind, static_cast<std::uint8_t>(error.code()));
  append_text(message, error.what());
  return message;
}

std::string process_name() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return fmt::format("process {} on {}", getpid(), host.data());
}

scene::Error take_error(MessageReader& reader) {
  const auto code = static_cast<scene::ErrorCode>(reader.take<std::uint8_t>());
  return {code, reader.take_text()};
}

}  // namespace tessera::exchange
