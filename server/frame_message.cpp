// SPDX-License-Identifier: BSD-3-Clause
#include "server/frame_message.hpp"

#include <cstdint>
#include <nlohmann/json.hpp>

namespace tessera::server {

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string frame_head(const Json& header) {
  const std::string text = text_of(header);
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string head;
  for (int shift = 0; shift < 32; shift += 8) head += static_cast<char>((length >> shift) & 0xff);
  return head + text;
}

std::string string_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace tessera::server
