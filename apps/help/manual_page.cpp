// SPDX-License-Identifier: BSD-3-Clause
#include "apps/help/manual_page.hpp"

#include <fmt/format.h>

#include "apps/commands/generate_command.hpp"
#include "apps/help/help_pages.hpp"
#include "tessera/program/text.hpp"
#include "tessera/version.hpp"

namespace tessera::apps {
namespace {

/// Escapes text for roff: a minus sign is not a hyphen, and no line starts a request.
std::string escaped(std::string_view text) {
  std::string result;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) result += "\\&";
    begins = c == '\n';
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  return result;
}

std::string entry(std::string_view form, std::string_view text) {
  return fmt::format(".TP\n.B {}\n{}\n", escaped(form), escaped(text));
}

std::string verbatim(std::string_view text) { return fmt::format(".nf\n{}\n.fi\n", escaped(text)); }

}  // namespace

std::string manual_page(const CommandRow* command) {
  const std::string name = command == nullptr ? "tessera" : fmt::format("tessera-{}", command->name);
  const std::string_view description = command == nullptr ? program_description : command->description;
  std::string page = fmt::format(".TH {} 1 \"\" \"Tessera {}\" \"Tessera\"\n.SH NAME\n{} \\- {}\n", upper_case(name),
                                 TESSERA_VERSION, escaped(name), escaped(description));
  page += ".SH SYNOPSIS\n" + escaped(usage_of(command)) + "\n";
  if (command == nullptr) {
    page += ".SH COMMANDS\n";
    for (const CommandRow& each : command_rows())
      page += entry(each.name, fmt::format("{}; see tessera-{}(1).", each.description, each.name));
  } else {
    std::string arguments;
    for (const OptionRow* row : option_rows(command->trait))
      if (row->is(Trait::positional)) arguments += entry(shown_name(*row), row->help);
    if (!arguments.empty()) page += ".SH ARGUMENTS\n" + arguments;
    const auto topics = help_topics(*command, true);
    if (!topics.empty()) page += ".SH OPTIONS\n";
    for (const HelpTopic& topic : topics) {
      if (topics.size() > 1) page += ".SS " + escaped(topic.title) + "\n";
      for (const OptionRow* row : topic.rows) page += entry(option_form(*row, true), row->help);
    }
    if (command->trait == Trait::generate) page += ".SH DETAILS\n" + verbatim(generator_help());
    if (!command->examples.empty()) page += ".SH EXAMPLES\n" + verbatim(command->examples);
  }
  page +=
      ".SH EXIT STATUS\n0 if all is done, 2 if arguments or input are wrong, 3 if the machine failed (memory, disk, a "
      "rank), 4 if "
      "\\-\\-verify found more error than was asked for.\n";
  return page;
}

}  // namespace tessera::apps
