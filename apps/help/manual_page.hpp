// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "apps/command_line.hpp"

namespace tessera::apps {

/// The manual page (section 1, roff) of a command; null: of the program.
std::string manual_page(const CommandRow* command);

}  // namespace tessera::apps
