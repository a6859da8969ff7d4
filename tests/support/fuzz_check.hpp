// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdlib>

#include "scene/error.hpp"

namespace tessera::test {

/// Runs a parser on arbitrary bytes. It may refuse them by Error(bad_input) with one printable line; any other
/// exception, or an invalid message, ends the process, which libFuzzer reports.
template <class Parse>
void parse_or_refuse(const Parse& parse) {
  try {
    parse();
  } catch (const scene::Error& error) {
    const std::string message = error.what();
    const bool one_line = std::all_of(message.begin(), message.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
    if (error.code() != scene::ErrorCode::bad_input || !one_line || message.size() > 400) std::abort();
  }
}

/// A condition that must hold for a parsed value.
inline void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace tessera::test
