// SPDX-License-Identifier: BSD-3-Clause
// Any text is parsed as a state in JSON or TOML or refused in one line; an accepted one survives being written in both.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "support/fuzz_check.hpp"
#include "tessera/state.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using tessera::State;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const auto& parse : {&State::from_json, &State::from_toml}) {
    tessera::test::parse_or_refuse([&] {
      const State state = parse(text, "state");
      // Bytes that are not UTF-8 are possible in TOML, and refused by json().
      tessera::test::parse_or_refuse(
          [&] { tessera::test::require(State::from_json(state.json()).words() == state.words()); });
      State saved = state;
      // A file written by this option does not contain the option.
      saved.set("save-config", std::vector<std::string>{});
      tessera::test::require(State::from_toml(saved.toml()).words() == saved.words());
    });
  }
  return 0;
}
