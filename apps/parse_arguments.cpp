// SPDX-License-Identifier: BSD-3-Clause
#include "apps/parse_arguments.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "apps/help/completion.hpp"
#include "apps/help/manual_page.hpp"
#include "apps/options/scene_file.hpp"
#include "tessera/error.hpp"
#include "tessera/program/nearest_name.hpp"

namespace tessera::apps {
namespace {

Error no_command(const CommandLine& line, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : line.commands()) names.push_back(command->get_name());
  if (const auto near = nearest_name(word, names))
    return bad_input(fmt::format("arguments: '{}' is no command; did you mean {}?", word, *near));
  std::string list = names.front();
  for (std::size_t i = 1; i < names.size(); ++i) list += (i + 1 < names.size() ? ", " : " or ") + names[i];
  return bad_input(fmt::format("arguments: '{}' is no command; use {}", word, list));
}

/// The first argument that looks like an option and is none.
std::optional<std::string> unknown_option(const CLI::App& command) {
  for (const std::string& word : command.remaining())
    if (word.size() > 1 && word.front() == '-') return word.substr(0, word.find('='));
  return std::nullopt;
}

Error no_option(const CLI::App& command, const std::string& word, const std::string& help) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  const auto near = nearest_name(word.substr(word.find_first_not_of('-')), names);
  return bad_input(near ? fmt::format("{}: is no option of {}; did you mean --{}?", word, command.get_name(), *near)
                        : fmt::format("{}: is no option of {}; see {}", word, command.get_name(), help));
}

/// `tessera help [COMMAND]`.
std::string help_page(const CommandLine& line) {
  if (line.help_of.empty() && line.manual) return manual_page(line, line.app);
  if (line.help_of.empty())
    return line.app.get_formatter()->make_help(&line.app, "tessera", CLI::AppFormatMode::Normal);
  const CLI::App* command = line.command(line.help_of);
  if (command == nullptr) throw no_command(line, line.help_of);
  if (line.manual) return manual_page(line, *command);
  const auto mode = line.help_all ? CLI::AppFormatMode::All : CLI::AppFormatMode::Normal;
  return command->get_formatter()->make_help(command, "tessera " + line.help_of, mode);
}

}  // namespace

bool parse(CommandLine& line, int argc, const char* const* argv, bool says) {
  const std::string first = argc > 1 ? argv[1] : "";
  const CLI::App* command = line.command(first);
  if (first == "complete") {  // what the scripts ask: of no interest to users, and no words to be checked
    std::string names;
    for (const std::string& name : completions(line, {argv + 2, argv + argc})) names += name + '\n';
    if (says) std::fputs(names.c_str(), stdout);
    return false;
  }
  // CLI11 would only say that a subcommand is missing.
  if (!first.empty() && first.front() != '-' && command == nullptr) throw no_command(line, first);
  const auto say = [&](const std::string& text) {
    if (says) std::fputs(text.c_str(), stdout);
    return false;
  };
  try {
    auto words = with_scene_file({argv + 1, argv + argc});
    std::ranges::reverse(words);  // as CLI11 takes them
    line.app.parse(std::move(words));
  } catch (const CLI::CallForVersion& version) {
    return say(std::string(version.what()) + "\n");
  } catch (const CLI::CallForAllHelp&) {
    return say(line.app.help("", CLI::AppFormatMode::All));
  } catch (const CLI::CallForHelp&) {
    return say(line.app.help());
  } catch (const CLI::ParseError& error) {
    const std::string help = command == nullptr ? "tessera --help" : fmt::format("tessera {} --help", first);
    const CLI::App& of = command == nullptr ? line.app : *command;
    if (const auto word = unknown_option(of)) throw no_option(of, *word, help);
    if (first == "serve" && !of.remaining().empty())
      throw bad_input(
          fmt::format("arguments: serve shows one file, and '{}' is a second; give a series as a pattern of its names, "
                      "like 'a_%d.vtu', or a .pvd or .series that lists them",
                      of.remaining().front()));
    throw bad_input(fmt::format("arguments: {}; see {}", error.what(), help));
  }
  if (*line.render && !line.words.save_config.empty()) line.words.scene = scene_text(*line.render);
  if (*line.completion) return say(completion_script(line.shell));
  return *line.help ? say(help_page(line)) : true;
}

}  // namespace tessera::apps
