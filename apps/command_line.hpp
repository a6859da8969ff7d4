// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

#include "tessera/program/options.hpp"

namespace tessera::apps {

/// A subcommand; its options are those rows of the table that have its trait.
struct CommandRow {
  Trait trait;
  std::string_view name, description;
  std::string_view examples;  ///< lines to begin with; empty for a command that needs none
};

/// In the order of help.
std::span<const CommandRow> command_rows();

/// Null for another word.
const CommandRow* command_named(std::string_view name);

/// `--help-all` has more options than `--help`.
inline bool has_topics(const CommandRow& command) {
  return command.trait == Trait::render || command.trait == Trait::serve;
}

}  // namespace tessera::apps
