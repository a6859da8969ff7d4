// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>

#include "server/scene_reader.hpp"

/// Conversion of messages of clients to values (docs/SERVER.md). The texts are not trusted.
namespace tessera::server {

/// A client's whole state. A state with a larger number replaces it.
struct StateMessage {
  std::uint64_t number = 0;
  bool moving = false;
  Json state;
};
/// The client has painted a frame.
struct AckMessage {
  std::uint64_t frame = 0;
};
/// The page is hidden: no frames until the next state.
struct PauseMessage {};
using Message = std::variant<StateMessage, AckMessage, PauseMessage>;

/// Parses a message. Throws Error(bad_input), with a message of one sentence, if the text is not JSON, the message's
/// type is unknown, or a member is missing or has the wrong type.
Message parse_message(std::string_view text);

/// Parses the JSON object in a request's body. Throws the same errors as parse_message().
Json parse_body(std::string_view text);

/// Returns an integer from a body, or `otherwise` if it is missing. Throws the same errors as parse_message().
std::int64_t whole_number(const Json& body, const char* name, std::int64_t otherwise, std::int64_t low,
                          std::int64_t high);

/// Returns the object `state` of a body. Throws the same errors as parse_message().
const Json& state_of(const Json& body);

}  // namespace tessera::server
