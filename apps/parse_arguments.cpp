// SPDX-License-Identifier: BSD-3-Clause
#include "apps/parse_arguments.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "apps/help/completion.hpp"
#include "apps/help/help_pages.hpp"
#include "tessera/error.hpp"
#include "tessera/program/nearest_name.hpp"
#include "tessera/program/render_options.hpp"
#include "tessera/version.hpp"

namespace tessera::apps {
namespace {

Error no_command(const std::string& word) {
  std::vector<std::string> names;
  for (const CommandRow& command : command_rows()) names.emplace_back(command.name);
  if (const auto near = nearest_name(word, names))
    return bad_input(fmt::format("arguments: '{}' is not a command; did you mean {}?", word, *near));
  const std::string last = std::move(names.back());
  names.pop_back();
  return bad_input(fmt::format("arguments: '{}' is not a command; use {} or {}", word, fmt::join(names, ", "), last));
}

/// Returns the first argument that looks like an option but is not one.
std::optional<std::string> unknown_option(const CLI::App& command) {
  for (const std::string& word : command.remaining())
    if (word.size() > 1 && word.front() == '-') return word.substr(0, word.find('='));
  return std::nullopt;
}

Error no_option(const CLI::App& command, const std::string& word, const std::string& help) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
  const auto near = nearest_name(word.substr(word.find_first_not_of('-')), names);
  return bad_input(
      near ? fmt::format("{}: it is not an option of {}; did you mean --{}?", word, command.get_name(), *near)
           : fmt::format("{}: it is not an option of {}; see {}", word, command.get_name(), help));
}

CLI::Option* declare(const OptionRow& row, CLI::App& command) {
  const std::string names = fmt::format("{}", fmt::join(written_names(row), ","));
  if (row.is(Trait::flag | Trait::place)) return command.add_flag(names);
  CLI::Option* const option = command.add_option(names, CLI::callback_t());
  option->type_name(std::string(row.value));
  // Each occurrence has one value. Otherwise, in `-o out.png mesh.vtu`, the mesh would be a second output.
  if (row.is(Trait::list))
    option->expected(1, CLI::detail::expected_max_vector_size)->take_all()->allow_extra_args(row.is(Trait::positional));
  return option;
}

/// The text for `tessera help [COMMAND]`.
std::string help_of(const OptionWords& words) {
  const std::string& name = words.word("command");
  const CommandRow* const command = command_named(name);
  if (!name.empty() && command == nullptr) throw no_command(name);
  return words.given("man") ? manual_page(command) : help_page(command, words.given("all"));
}

/// Parser of all subcommands with their options, and the given words.
struct CommandLine {
  CommandLine() : app("", "tessera") {
    app.set_version_flag("--version",
                         fmt::format("tessera {}\ncommit {}\nbuilt by {}", version(), commit(), build_facts()));
    app.set_help_flag("-h,--help");
    app.require_subcommand(1);
    for (const CommandRow& command : command_rows()) {
      CLI::App* const declared = app.add_subcommand(std::string(command.name));
      if (command.trait == Trait::render) declared->set_help_all_flag("--help-all");
      for (const OptionRow* row : option_rows(command.trait)) options.emplace_back(row, declare(*row, *declared));
    }
  }

  CLI::App app;
  std::vector<std::pair<const OptionRow*, CLI::Option*>> options;
};

/// Whether a flag is on: `--smooth`, or `--smooth=yes`.
bool is_on(const OptionRow& row, const std::string& word) {
  try {
    if (const auto value = CLI::detail::to_flag_value(word); value == 1 || value == -1) return value == 1;
  } catch (const std::logic_error&) {  // the word is not a value of a flag
  }
  throw bad_input(fmt::format("{}: it takes no value; leave the value out", shown_name(row)));
}

OptionWords words_of(const CommandLine& line, Trait command) {
  OptionWords words(command);
  for (const auto& [row, option] : line.options)
    if (option->count() > 0) {
      const std::vector<std::string> given = option->reduced_results();
      if (!row->is(Trait::flag))
        words.set(row->key(), given);
      else if (is_on(*row, given.back()))
        words.set(row->key(), "true");
    }
  return words;
}

}  // namespace

std::optional<Arguments> parse_arguments(int argc, const char* const* argv, bool prints) {
  const std::string first = argc > 1 ? argv[1] : "";
  const CommandRow* const command = command_named(first);
  const auto print = [&](const std::string& text) {
    if (prints) std::fputs(text.c_str(), stdout);
    return std::nullopt;
  };
  if (first == "complete") {  // an internal command for completion scripts, whose words are not checked
    std::string names;
    for (const std::string& name : completions({argv + 2, argv + argc})) names += name + '\n';
    return print(names);
  }
  // CLI11 would only report that a subcommand is missing.
  if (!first.empty() && first.front() != '-' && command == nullptr) throw no_command(first);
  const std::string help = command == nullptr ? "tessera --help" : fmt::format("tessera {} --help", first);
  CommandLine line;
  std::optional<OptionWords> words;
  try {
    line.app.parse(argc, argv);
    words = words_of(line, command->trait);
  } catch (const CLI::CallForVersion& version) {
    return print(std::string(version.what()) + "\n");
  } catch (const CLI::CallForAllHelp&) {
    return print(help_page(command, true));
  } catch (const CLI::CallForHelp&) {
    return print(help_page(command, false));
  } catch (const CLI::ParseError& error) {
    const CLI::App& of = command == nullptr ? line.app : *line.app.get_subcommand(first);
    if (const auto word = unknown_option(of)) throw no_option(of, *word, help);
    if (first == "serve" && !of.remaining().empty())
      throw bad_input(
          fmt::format("arguments: serve shows only one file, but '{}' is a second; give a series as a pattern of its "
                      "names, like 'a_%d.vtu', or a .pvd or .series that lists them",
                      of.remaining().front()));
    throw bad_input(fmt::format("arguments: {}; see {}", error.what(), help));
  }
  if (command->trait == Trait::completion && words->given("shell"))
    return print(completion_script(words->word("shell")));
  if (command->trait == Trait::help) return print(help_of(*words));
  if (words->given("config")) {
    const std::string& file = words->word("config");
    words->set_defaults(State::from_toml(read_text(file), file));
  }
  for (const OptionRow* row : option_rows(command->trait))
    if (row->is(Trait::required) && !words->given(row->key()))
      throw bad_input(fmt::format("arguments: {} is required; see {}", shown_name(*row), help));
  return Arguments{command, std::move(*words)};
}

}  // namespace tessera::apps
