// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "apps/command_line.hpp"

namespace tessera::apps {

/// The words of the program's arguments: of `render` with those of its --config.
struct Arguments {
  const CommandRow* command;  ///< never null
  OptionWords words;
};

/// Nothing if all is done: help or the version was asked for, and printed on standard output where `says`. Throws
/// Error(bad_input) for what cannot be understood, with the nearest name.
std::optional<Arguments> parse_arguments(int argc, const char* const* argv, bool says);

}  // namespace tessera::apps
