// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

#include "tessera/program/options.hpp"

namespace tessera::apps {

/// A subcommand. Its options are the rows of the option table that have its trait.
struct CommandRow {
  Trait trait;
  std::string_view name, description;
  std::string_view examples;  ///< examples for the help; empty for a command that needs none
};

/// All commands, in the order of the help.
std::span<const CommandRow> command_rows();

/// Returns the command of this name; null for any other word.
const CommandRow* command_named(std::string_view name);

/// Whether `--help-all` shows more options than `--help`.
inline bool has_topics(const CommandRow& command) {
  return command.trait == Trait::render || command.trait == Trait::serve;
}

}  // namespace tessera::apps
