// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "apps/command_line.hpp"

namespace tessera::apps {

/// Puts the program's arguments into `line`. False if all is done: help or the version was asked for, and said on
/// standard output where `says`. Throws Error(bad_input) for what cannot be understood, with the nearest name.
bool parse(CommandLine& line, int argc, const char* const* argv, bool says);

}  // namespace tessera::apps
