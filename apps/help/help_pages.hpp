// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace tessera::apps {

/// The options of one topic, in the order of their declaration.
struct HelpTopic {
  std::string title;
  std::vector<const CLI::Option*> options;
};

/// A command's options by topic. Of a command with many only those that most users want, unless `all`; the others of
/// `render` that no topic names come last. Without --help.
std::vector<HelpTopic> help_topics(const CLI::App& command, bool all);

/// How an option is written before its description: "-o, --output FILE", a long choice of words cut short unless `all`.
std::string option_form(const CLI::Option& option, bool all);

/// "tessera render [OPTIONS] INPUT [MORE...]", `name` being what is called.
std::string usage_of(const CLI::App& command, const std::string& name);

/// Three or so commands to begin with; empty for a command that needs none.
std::vector<std::string> help_examples(const CLI::App& command);

/// What `--help` and `--help-all` print, at most 100 columns wide.
class HelpPages final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* command, std::string name, CLI::AppFormatMode mode) const override;
};

}  // namespace tessera::apps
