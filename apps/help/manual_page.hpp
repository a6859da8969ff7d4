// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "apps/command_line.hpp"

namespace tessera::apps {

/// The manual page (section 1, roff) of a command, or of the program for `line.app`.
std::string manual_page(const CommandLine& line, const CLI::App& command);

}  // namespace tessera::apps
