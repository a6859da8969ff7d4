// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "apps/command_line.hpp"

namespace tessera::apps {

/// The command and the words of the program's arguments. For `render` they include the words of --config.
struct Arguments {
  const CommandRow* command;  ///< never null
  OptionWords words;
};

/// Parses the arguments. Returns none if they request the help or the version, which is printed on standard output if
/// `prints`. Throws Error(bad_input), which suggests the nearest name, for invalid arguments.
std::optional<Arguments> parse_arguments(int argc, const char* const* argv, bool prints);

}  // namespace tessera::apps
