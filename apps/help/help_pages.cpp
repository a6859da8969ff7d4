// SPDX-License-Identifier: BSD-3-Clause
#include "apps/help/help_pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/commands/generate_command.hpp"
#include "tessera/program/text.hpp"
#include "tessera/version.hpp"

namespace tessera::apps {
namespace {

constexpr std::string_view program_description =
    "Tessera renders scientific volumes: unstructured meshes and regular grids, exactly, on the CPU.";
constexpr std::size_t page_columns = 100, left_column = 30;

/// Breaks text into lines. A word that is longer than a line gets a separate line.
std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
  std::vector<std::string> lines(1);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t stop = std::min(text.find(' ', at), text.size());
    const std::string_view word = text.substr(at, stop - at);
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + std::string(word);
    at = stop + 1;
  }
  return lines;
}

/// Returns the description or, if it is longer than `width`, its part before the first semicolon or bracket.
std::string_view first_words(std::string_view description, std::size_t width) {
  if (description.size() <= width) return description;
  const std::size_t cut = std::min(description.find("; "), description.find(" ("));
  return description.substr(0, cut);
}

void add_entry(std::string& page, const std::string& form, std::string_view description) {
  const auto lines = wrapped(description, page_columns - left_column);
  page += "  " + form;
  const bool apart = form.size() + 4 > left_column;
  if (!apart) page.append(left_column - form.size() - 2, ' ');
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (apart || i > 0) page += "\n" + std::string(left_column, ' ');
    page += lines[i];
  }
  page += '\n';
}

/// A command's options under one title, without positional words. For `render`, contains only the basic options unless
/// `all`.
struct HelpTopic {
  std::string_view title;
  std::vector<const OptionRow*> rows;
};

std::vector<HelpTopic> help_topics(const CommandRow& command, bool all) {
  std::vector<HelpTopic> result;
  for (const OptionTopic& topic : option_topics()) {
    HelpTopic shown{topic.title, {}};
    for (const OptionRow& row : topic.rows)
      if (row.is(command.trait) && !row.is(Trait::positional) && (all || row.is(Trait::basic)))
        shown.rows.push_back(&row);
    if (shown.rows.empty()) continue;
    // A command with few options has a single topic.
    if (has_topics(command) || result.empty())
      result.push_back(std::move(shown));
    else
      result.front().rows.insert(result.front().rows.end(), shown.rows.begin(), shown.rows.end());
    if (!has_topics(command)) result.front().title = "Options";
  }
  return result;
}

/// Returns the usage of a command, "tessera render [OPTIONS] INPUT [MORE...]", or of the program if `command` is null.
std::string usage_of(const CommandRow* command) {
  if (command == nullptr) return "tessera COMMAND";
  std::string line = fmt::format("tessera {} [OPTIONS]", command->name);
  for (const OptionRow* row : option_rows(command->trait)) {
    if (!row->is(Trait::positional)) continue;
    const std::string form = shown_name(*row) + (row->is(Trait::list) ? "..." : "");
    line += row->is(Trait::required) ? " " + form : " [" + form + "]";
  }
  return line;
}

/// Escapes text for roff, so that a minus sign is not a hyphen and no line is read as a request.
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

std::vector<std::string> written_names(const OptionRow& row) {
  if (row.is(Trait::positional)) return {upper_case(row.names)};
  std::vector<std::string> names;
  for (std::string_view rest = row.names; !rest.empty();) {
    const std::string_view name = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(name.size() + 1, rest.size()));
    names.push_back(fmt::format("{}{}", name != row.key() && name.size() == 1 ? "-" : "--", name));
  }
  return names;
}

std::string shown_name(const OptionRow& row) {
  return row.is(Trait::positional) ? upper_case(row.names) : fmt::format("--{}", row.key());
}

std::string option_form(const OptionRow& row, bool all) {
  std::vector<std::string> names = written_names(row);
  if (!all) names.resize(names.front().starts_with("--") ? 1 : 2);
  std::string form = fmt::format("{}", fmt::join(names, ", "));
  if (row.value.empty() || row.is(Trait::flag | Trait::place)) return form;
  std::string type(row.value);
  const std::size_t room = left_column > form.size() + 5 ? left_column - form.size() - 5 : 0;
  if (!all && type.size() > room && type.find('|') != std::string::npos) {
    const std::size_t bar = type.rfind('|', room >= 4 ? room - 4 : 0);
    type = bar == std::string::npos ? "WORD" : type.substr(0, bar + 1) + "...";
  }
  return form + " " + type;
}

std::string help_page(const CommandRow* command, bool all) {
  if (command == nullptr) {
    std::string page = fmt::format("{}\nUsage: {}\n\nCommands:\n", program_description, usage_of(nullptr));
    for (const CommandRow& each : command_rows()) add_entry(page, std::string(each.name), each.description);
    page += "\nOptions:\n";
    add_entry(page, "--version", "print the version, the commit and the build options");
    return page + "\n`tessera help COMMAND` describes each command.\n";
  }
  const bool is_render = command->trait == Trait::render;
  all = all || !is_render;
  std::string page = fmt::format("{}\nUsage: {}\n", command->description, usage_of(command));
  for (std::string_view rest = command->examples; !rest.empty();) {
    const std::string_view example = rest.substr(0, rest.find('\n'));
    page += fmt::format("  {}\n", example);
    rest.remove_prefix(std::min(example.size() + 1, rest.size()));
  }
  bool has_positionals = false;
  for (const OptionRow* row : option_rows(command->trait)) {
    if (!row->is(Trait::positional)) continue;
    if (!std::exchange(has_positionals, true)) page += '\n';
    add_entry(page, shown_name(*row), all ? row->help : first_words(row->help, 2 * (page_columns - left_column)));
  }
  for (const HelpTopic& topic : help_topics(*command, all)) {
    page += fmt::format("{}{}:\n", all ? "\n" : "", topic.title);
    for (const OptionRow* row : topic.rows)
      add_entry(page, option_form(*row, all), all ? row->help : first_words(row->help, page_columns - left_column));
  }
  if (is_render)
    page += all ? "\nThe guide, docs/GUIDE.md, is organized by task.\n"
                : "--help-all lists all options, `tessera formats` the files that are read.\n";
  if (command->trait == Trait::generate) page += '\n' + generator_help() + '\n';
  return page;
}

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
