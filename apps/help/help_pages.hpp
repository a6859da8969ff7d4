// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "apps/command_line.hpp"

namespace tessera::apps {

/// A command's options under one title, without words that have no name. For `render` only the basic ones, unless
/// `all`.
struct HelpTopic {
  std::string_view title;
  std::vector<const OptionRow*> rows;
};
std::vector<HelpTopic> help_topics(const CommandRow& command, bool all);

/// "-o" and "--output", or "INPUT".
std::vector<std::string> written_names(const OptionRow& row);

/// "--output", or "INPUT".
std::string shown_name(const OptionRow& row);

/// The form of an option in front of its description: "-o, --output FILE"; a long list of choices is shortened unless
/// `all`.
std::string option_form(const OptionRow& row, bool all);

/// "tessera render [OPTIONS] INPUT [MORE...]"; null: for the program.
std::string usage_of(const CommandRow* command);

/// A one-line description of the program.
inline constexpr std::string_view program_description =
    "Tessera renders scientific volumes: unstructured meshes and regular grids, exactly, on the CPU.";

/// The text of `--help` and `--help-all`, at most 100 columns wide; null: for the program.
std::string help_page(const CommandRow* command, bool all);

}  // namespace tessera::apps
