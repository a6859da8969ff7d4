// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "apps/command_line.hpp"

namespace tessera::apps {

/// The words of the program's arguments; for `render` including those of its --config.
struct Arguments {
  const CommandRow* command;  ///< never null
  OptionWords words;
};

/// None if nothing remains to do: help or the version was requested, and is printed on standard output if `prints`.
/// Throws Error(bad_input) for invalid arguments, suggesting the nearest name.
std::optional<Arguments> parse_arguments(int argc, const char* const* argv, bool prints);

}  // namespace tessera::apps
