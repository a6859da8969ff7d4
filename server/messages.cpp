// SPDX-License-Identifier: BSD-3-Clause
#include "server/messages.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tessera/error.hpp"
#include "tessera/input_file.hpp"

namespace tessera::server {
namespace {

/// Largest number of values in a message. A page's state has a few hundred values, or about ten thousand with a dense
/// transfer function.
constexpr std::size_t most_values = 100'000;

Json parse_object(std::string_view text, const char* what) {
  check_json(text, what, most_values);
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) throw bad_input(fmt::format("{}: is not a JSON object; send one", what));
  return json;
}

std::uint64_t number_of(const Json& message, const char* name) {
  const auto found = message.find(name);
  if (found == message.end() || !found->is_number_unsigned())
    throw bad_input(fmt::format("message: its '{}' is not a whole number from 0; send one", name));
  return found->get<std::uint64_t>();
}

}  // namespace

Message parse_message(std::string_view text) {
  Json json = parse_object(text, "message");
  const auto type = json.find("type");
  if (type == json.end() || !type->is_string()) throw bad_input("message: its 'type' is not text; send one");
  const auto& name = type->get_ref<const std::string&>();
  if (name == "ack") return AckMessage{number_of(json, "frame")};
  if (name == "pause") return PauseMessage{};
  if (name != "state") throw bad_input("message: its 'type' is unknown; use state, ack or pause");
  StateMessage message;
  message.number = number_of(json, "number");
  if (const auto moving = json.find("moving"); moving != json.end()) {
    if (!moving->is_boolean()) throw bad_input("message: its 'moving' is neither true nor false; send one of them");
    message.moving = moving->get<bool>();
  }
  const auto state = json.find("state");
  if (state == json.end() || !state->is_object()) throw bad_input("message: its 'state' is not an object; send one");
  message.state = std::move(*state);
  return message;
}

Json parse_body(std::string_view text) { return parse_object(text, "body"); }

std::int64_t whole_number(const Json& body, const char* name, std::int64_t otherwise, std::int64_t low,
                          std::int64_t high) {
  const auto found = body.find(name);
  if (found == body.end()) return otherwise;
  const bool is_whole = found->is_number_integer();
  // Unsigned numbers beyond int64 are always too large.
  const bool fits = is_whole && (!found->is_number_unsigned() || found->get<std::uint64_t>() <= std::uint64_t(high));
  if (!fits || found->get<std::int64_t>() < low || found->get<std::int64_t>() > high)
    throw bad_input(fmt::format("{}: is not a whole number from {} to {}; send one", name, low, high));
  return found->get<std::int64_t>();
}

const Json& state_of(const Json& body) {
  const auto state = body.find("state");
  if (state == body.end() || !state->is_object()) throw bad_input("state: is not an object; send one");
  return *state;
}

}  // namespace tessera::server
