// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "apps/command_line.hpp"

namespace tessera::apps {

/// "-o" and "--output", or "INPUT".
std::vector<std::string> written_names(const OptionRow& row);

/// "--output", or "INPUT".
std::string shown_name(const OptionRow& row);

/// The form of an option in front of its description: "-o, --output FILE"; a long list of choices is shortened unless
/// `all`.
std::string option_form(const OptionRow& row, bool all);

/// The text of `--help` and `--help-all`, at most 100 columns wide; null: for the program.
std::string help_page(const CommandRow* command, bool all);

/// The manual page (section 1, roff) of a command; null: of the program.
std::string manual_page(const CommandRow* command);

}  // namespace tessera::apps
