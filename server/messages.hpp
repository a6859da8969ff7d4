// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>

#include "server/scene_reader.hpp"

/// Messages of clients as values (docs/SERVER.md). The texts are not trusted.
namespace tessera::server {

/// A client's whole state; a later one with a larger number replaces it.
struct StateMessage {
  std::uint64_t number = 0;
  bool moving = false;
  Json state;
};
/// A frame has been painted.
struct AckMessage {
  std::uint64_t frame = 0;
};
/// The page is hidden: no frames until the next state.
struct PauseMessage {};
using Message = std::variant<StateMessage, AckMessage, PauseMessage>;

/// Throws Error(bad_input) in one sentence: not JSON, an unknown type, a missing member or one of the wrong type.
Message parse_message(std::string_view text);

/// The JSON object of a request's body. Throws as parse_message().
Json parse_body(std::string_view text);

/// An integer from a body, `otherwise` if it is missing. Throws as parse_message().
std::int64_t whole_number(const Json& body, const char* name, std::int64_t otherwise, std::int64_t low,
                          std::int64_t high);

/// The object `state` of a body. Throws as parse_message().
const Json& state_of(const Json& body);

}  // namespace tessera::server
