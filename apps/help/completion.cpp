// SPDX-License-Identifier: BSD-3-Clause
#include "apps/help/completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <system_error>

#include "apps/command_line.hpp"
#include "apps/commands/generate_command.hpp"
#include "apps/help/help_pages.hpp"
#include "apps/render/report.hpp"
#include "tessera/dataset.hpp"
#include "tessera/presets.hpp"
#include "tessera/program/printable.hpp"

namespace tessera::apps {
namespace {

/// Size of the largest file that is read to list names. A larger file would cause a noticeable delay at the prompt.
constexpr std::uintmax_t largest_read = std::uintmax_t{512} << 20;

/// The option of a word like --size or -o; null if there is none.
const OptionRow* option_named(const CommandRow& command, std::string_view word) {
  if (!word.starts_with('-')) return nullptr;
  const std::string_view name = word.substr(word.starts_with("--") ? 2 : 1);
  const OptionRow* const row = find_option(command.trait, name);
  return row == nullptr || row->is(Trait::positional) ? nullptr : row;
}

enum class Named { fields, blocks, point_vectors };

/// Returns names from the first of the words that is a file, if the file can be read quickly.
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
      std::erase_if(names, [](const std::string& name) { return printable(name) != name; });  // the shell expects one
                                                                                              // name per line
      return names;
    } catch (const std::exception&) {  // the word may be the name of an image or of a damaged file
      continue;
    }
  }
  return {};
}

/// Names of colours or, if `current` contains a colon, of colours with opacities.
std::vector<std::string> preset_words(std::string_view current) {
  std::vector<std::string> colors = preset_names();
  const std::string name(current.substr(0, current.find(':')));
  if (name.size() == current.size() || std::ranges::find(colors, name) == colors.end()) return colors;
  std::vector<std::string> found;
  for (const std::string& opacity : preset_opacity_names()) found.push_back(fmt::format("{}:{}", name, opacity));
  return found;
}

/// Returns the values of an option that begin with `current`. Sets `files` if the value may be a file.
std::vector<std::string> values_of(const OptionRow& row, const std::vector<std::string>& words,
                                   std::string_view current, bool& files) {
  const std::string_view name = row.key();
  files = row.value.find("FILE") != std::string_view::npos;
  if (name == "field") return names_in_file(words, Named::fields);
  if (name == "block") return names_in_file(words, Named::blocks);
  if (name == "warp") return names_in_file(words, Named::point_vectors);
  if (name == "surface") return {"boundary"};
  if (name == "transfer-function") return preset_words(current);
  const auto choices = row.choices();
  return {choices.begin(), choices.end()};
}

std::vector<std::string> all_commands() {
  std::vector<std::string> names;
  for (const CommandRow& command : command_rows()) names.emplace_back(command.name);
  return names;
}

std::vector<std::string> candidates(const std::vector<std::string>& words, bool& files) {
  const std::string& current = words.back();
  if (words.size() == 1) return all_commands();
  const CommandRow* const command = command_named(words.front());
  if (command == nullptr) return {};
  const std::vector<std::string> before(words.begin() + 1, words.end() - 1);
  std::vector<std::string> found;
  if (const std::size_t equals = current.find('='); current.starts_with("--") && equals != std::string::npos) {
    const std::string name = current.substr(0, equals);
    if (const OptionRow* row = option_named(*command, name))
      for (const std::string& value : values_of(*row, before, std::string_view(current).substr(equals + 1), files))
        found.push_back(fmt::format("{}={}", name, value));
    return found;
  }
  if (const OptionRow* row = before.empty() ? nullptr : option_named(*command, before.back());
      row != nullptr && !row->is(Trait::flag | Trait::place))
    return values_of(*row, before, current, files);
  if (current.starts_with('-')) {
    found.emplace_back("--help");
    if (command->trait == Trait::render) found.emplace_back("--help-all");
    for (const OptionRow* row : option_rows(command->trait)) {
      if (row->is(Trait::positional)) continue;
      for (std::string& name : written_names(*row))
        if (name.starts_with("--")) found.push_back(std::move(name));
    }
    return found;
  }
  if (command->trait == Trait::help) return all_commands();
  if (command->trait == Trait::completion) return {"bash", "zsh", "fish"};
  if (command->trait == Trait::generate && words.size() == 2) return generator_names();
  files = true;
  return {};
}

}  // namespace

std::vector<std::string> completions(const std::vector<std::string>& words) {
  if (words.empty()) return {};
  bool files = false;
  std::vector<std::string> found = candidates(words, files);
  std::erase_if(found, [&](const std::string& name) {
    return !name.starts_with(words.back()) || name.find('\n') != std::string::npos;
  });
  if (files) found.insert(found.begin(), std::string(file_completion));
  return found;
}

}  // namespace tessera::apps
