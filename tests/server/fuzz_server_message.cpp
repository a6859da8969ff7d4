// SPDX-License-Identifier: BSD-3-Clause
// Any text is parsed as a client's message or refused in one line; an accepted state becomes options of render, which
// survive a shell unchanged.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "server/messages.hpp"
#include "support/fuzz_check.hpp"
#include "tessera/program/state_words.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  test::parse_or_refuse([&] {
    const server::Message message = server::parse_message(text);
    const auto* const state = std::get_if<server::StateMessage>(&message);
    if (state == nullptr) return;
    OptionWords started;
    started.set("field", "p");
    started.set("view", "front");
    const OptionWords words = state_words(started, state->state);
    for (const auto& [option, values] : words.all()) test::require(!option.empty() && !values.empty());
    for (const std::string& argument : arguments_of(words)) {
      test::require(argument.starts_with("--"));
      test::require(argument.find('\n') == std::string::npos);
    }
    test::require(!shell_words(arguments_of(words)).starts_with(' '));
  });
  test::parse_or_refuse([&] {
    const server::Json body = server::parse_body(text);
    server::state_of(body);
    server::whole_number(body, "bins", 1, 0, 100);
  });
  return 0;
}
