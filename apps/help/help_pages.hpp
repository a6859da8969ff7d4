// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "apps/command_line.hpp"

namespace tessera::apps {

/// The option's names as written on the command line: "-o" and "--output", or "INPUT".
std::vector<std::string> written_names(const OptionRow& row);

/// The option's main name as written on the command line: "--output", or "INPUT".
std::string shown_name(const OptionRow& row);

/// The form in which the help shows an option before its description: "-o, --output FILE". A long list of choices is
/// shortened unless `all`.
std::string option_form(const OptionRow& row, bool all);

/// The text of `--help` or, if `all`, `--help-all`, at most 100 columns wide. If `command` is null, the text is that of
/// the program.
std::string help_page(const CommandRow* command, bool all);

/// The manual page (section 1, roff) of a command or, if `command` is null, of the program.
std::string manual_page(const CommandRow* command);

}  // namespace tessera::apps
