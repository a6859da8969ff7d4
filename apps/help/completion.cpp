// SPDX-License-Identifier: BSD-3-Clause
#include "apps/help/completion.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <system_error>

#include "apps/commands/generate_command.hpp"
#include "apps/render/report.hpp"
#include "tessera/dataset.hpp"
#include "tessera/presets.hpp"
#include "tessera/program/printable.hpp"
#include "tessera/program/text.hpp"

namespace tessera::apps {
namespace {

/// Reading more than this to list names would be felt at the prompt.
constexpr std::uintmax_t largest_read = std::uintmax_t{512} << 20;

const CLI::Option* option_named(const CLI::App& command, const std::string& word) {
  return word.size() > 1 && word.front() == '-' ? command.get_option_no_throw(word) : nullptr;
}

/// "a|b|c" as its words, if all of them are meant literally: capitals and colons stand for something.
std::vector<std::string> literal_words(const std::string& type) {
  const auto stands_for_something = [](char c) { return is_upper(c) || c == ':' || c == '['; };
  if (type.find('|') == std::string::npos || std::ranges::any_of(type, stands_for_something)) return {};
  return CLI::detail::split(type, '|');
}

enum class Named { fields, blocks, point_vectors };

/// Names in the first of these words that is a file, if it can be read soon.

std::vector<std::string> names_in_file(const std::vector<std::string>& words, Named named) {
  for (const std::string& word : words) {
    std::error_code unknown;
    if (word.starts_with('-') || !std::filesystem::is_regular_file(word, unknown)) continue;
    if (std::filesystem::file_size(word, unknown) > largest_read) return {};
    try {
      const analysis::Description data = described(Dataset::open(word, {}));
      std::vector<std::string> names;
      if (named == Named::blocks) names = data.blocks;
      for (const auto& field : data.fields)
        if (named == Named::fields ||
            (named == Named::point_vectors && field.components == 3 && field.association == Association::point))
          names.push_back(field.name);
      if (named == Named::point_vectors) names.emplace_back("off");
      std::erase_if(names, [](const std::string& name) { return printable(name) != name; });  // a line each
      return names;
    } catch (const std::exception&) {  // a picture's name, or a damaged file
      continue;
    }
  }
  return {};
}

/// Colours; with an opacity each once a colon stands.
std::vector<std::string> preset_words(std::string_view current) {
  std::vector<std::string> colors = preset_names();
  const std::string name(current.substr(0, current.find(':')));
  if (name.size() == current.size() || std::ranges::find(colors, name) == colors.end()) return colors;
  std::vector<std::string> found;
  for (const std::string& opacity : preset_opacity_names()) found.push_back(fmt::format("{}:{}", name, opacity));
  return found;
}

/// What an option's value may be, whose beginning is `current`; `files` is set where it may be a file.
std::vector<std::string> values_of(const CLI::Option& option, const std::vector<std::string>& words,
                                   std::string_view current, bool& files) {
  const std::string name = option.get_lnames().empty() ? "" : option.get_lnames().front();
  const std::string type = option.get_type_name();
  files = type.find("FILE") != std::string::npos;
  if (name == "field") return names_in_file(words, Named::fields);
  if (name == "block") return names_in_file(words, Named::blocks);
  if (name == "warp") return names_in_file(words, Named::point_vectors);
  if (name == "surface") return {"boundary"};
  if (name == "transfer-function") return preset_words(current);
  return literal_words(type);
}

std::vector<std::string> command_names(const CommandLine& line) {
  std::vector<std::string> names;
  for (const CLI::App* command : line.commands()) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> candidates(const CommandLine& line, const std::vector<std::string>& words, bool& files) {
  const std::string& current = words.back();
  if (words.size() == 1) return command_names(line);
  const CLI::App* command = line.command(words.front());
  if (command == nullptr) return {};
  const std::vector<std::string> before(words.begin() + 1, words.end() - 1);
  std::vector<std::string> found;
  if (const std::size_t equals = current.find('='); current.starts_with("--") && equals != std::string::npos) {
    const std::string name = current.substr(0, equals);
    if (const CLI::Option* option = option_named(*command, name))
      for (const std::string& value : values_of(*option, before, std::string_view(current).substr(equals + 1), files))
        found.push_back(fmt::format("{}={}", name, value));
    return found;
  }
  if (const CLI::Option* option = before.empty() ? nullptr : option_named(*command, before.back());
      option != nullptr && option->get_type_size() != 0 && option->get_expected_min() > 0)
    return values_of(*option, before, current, files);
  if (current.starts_with('-')) {
    for (const CLI::Option* option : command->get_options())
      if (!option->get_group().empty())
        for (const std::string& name : option->get_lnames()) found.push_back("--" + name);
    return found;
  }
  if (command == line.help) return command_names(line);
  if (command == line.completion) return {"bash", "zsh", "fish"};
  if (command == line.generate && words.size() == 2) return generator_names();
  files = true;
  return {};
}

}  // namespace

std::vector<std::string> completions(const CommandLine& line, const std::vector<std::string>& words) {
  if (words.empty()) return {};
  bool files = false;
  std::vector<std::string> found = candidates(line, words, files);
  std::erase_if(found, [&](const std::string& name) {
    return !name.starts_with(words.back()) || name.find('\n') != std::string::npos;
  });
  if (files) found.insert(found.begin(), std::string(file_completion));
  return found;
}

}  // namespace tessera::apps
