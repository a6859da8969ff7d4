// SPDX-License-Identifier: BSD-3-Clause
#include "apps/help/manual_page.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/help/help_pages.hpp"
#include "tessera/program/text.hpp"
#include "tessera/version.hpp"

namespace tessera::apps {
namespace {

/// As roff prints it unchanged: a minus sign is no hyphen, and no line begins a request.
std::string escaped(const std::string& text) {
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

std::string entry(const std::string& form, const std::string& text) {
  return fmt::format(".TP\n.B {}\n{}\n", escaped(form), escaped(text));
}

std::string verbatim(const std::string& text) { return fmt::format(".nf\n{}\n.fi\n", escaped(text)); }

}  // namespace

std::string manual_page(const CommandLine& line, const CLI::App& command) {
  const bool is_program = command.get_parent() == nullptr;
  const std::string name = is_program ? "tessera" : "tessera-" + command.get_name();
  const std::string call = is_program ? "tessera" : "tessera " + command.get_name();
  std::string page = fmt::format(".TH {} 1 \"\" \"Tessera {}\" \"Tessera\"\n.SH NAME\n{} \\- {}\n", upper_case(name),
                                 TESSERA_VERSION, escaped(name), escaped(command.get_description()));
  page += ".SH SYNOPSIS\n" + escaped(usage_of(command, call)) + "\n";
  const auto positionals = command.get_options([](const CLI::Option* o) { return o->get_positional(); });
  if (!positionals.empty()) page += ".SH ARGUMENTS\n";
  for (const CLI::Option* word : positionals) page += entry(word->get_name(true), word->get_description());
  if (is_program) {
    page += ".SH COMMANDS\n";
    for (const CLI::App* each : line.commands())
      page += entry(each->get_name(), fmt::format("{}; see tessera-{}(1).", each->get_description(), each->get_name()));
  }
  const auto topics = help_topics(command, true);
  if (!topics.empty()) page += ".SH OPTIONS\n";
  for (const HelpTopic& topic : topics) {
    if (topics.size() > 1) page += ".SS " + escaped(topic.title) + "\n";
    for (const CLI::Option* option : topic.options)
      page += entry(option_form(*option, true), option->get_description());
  }
  if (const std::string footer = command.get_footer(); !footer.empty()) page += ".SH DETAILS\n" + verbatim(footer);
  if (const auto examples = help_examples(command); !examples.empty()) {
    page += ".SH EXAMPLES\n";
    for (const std::string& example : examples) page += verbatim(example);
  }
  page +=
      ".SH EXIT STATUS\n0 if all is done, 2 if arguments or input are wrong, 3 if the machine failed (memory, disk, a "
      "rank), 4 if "
      "\\-\\-verify found more error than was asked for.\n";
  return page;
}

}  // namespace tessera::apps
