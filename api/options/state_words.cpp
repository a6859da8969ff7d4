// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/program/state_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "api/options/state_text.hpp"
#include "api/options/surface_file_name.hpp"
#include "tessera/dataset.hpp"
#include "tessera/error.hpp"
#include "tessera/program/nearest_name.hpp"
#include "tessera/program/text.hpp"
#include "tessera/view.hpp"

namespace tessera {
namespace api {
namespace {

using Json = nlohmann::json;

const OptionRow& key_named(const std::string& name) {
  std::vector<std::string> names;
  for (const OptionRow* row : option_rows(Trait::state)) {
    if (row->key() == name) return *row;
    names.emplace_back(row->key());
  }
  if (const auto near = nearest_name(name, names))
    throw bad_input(fmt::format("state: {} is not a setting; did you mean {}?", quote(name), *near));
  throw bad_input(fmt::format("state: {} is not a setting; docs/SERVER.md lists them", quote(name)));
}

/// Throws if there are too many texts or if they are too long. The texts come from the network.
void check_texts(const OptionRow& row, const std::vector<std::string>& texts) {
  constexpr std::size_t most = 64, longest = 4096;
  if (texts.size() > most)
    throw bad_input(fmt::format("state: '{}' has more than {} values; send fewer", row.key(), most));
  for (const std::string& text : texts) {
    if (text.size() > longest && !(row.is(Trait::camera | Trait::function) && is_json_text(text)))
      throw bad_input(fmt::format("state: '{}' has more than {} bytes; make it shorter", row.key(), longest));
    if (std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }))
      throw bad_input(fmt::format("state: '{}' has control characters; leave them out", row.key()));
  }
}

bool is_preset(const std::string& text) {
  const std::vector<std::string> presets = preset_names();
  return std::ranges::find(presets, text.substr(0, text.find(':'))) != presets.end();
}

/// Throws for the name of a file: from the network, only JSON text and presets are accepted.
void check_no_file(const OptionRow& row, const std::string& text) {
  if (is_json_text(text)) return;
  if (row.is(Trait::camera))
    throw bad_input("state: 'camera' must be a JSON object; send a camera as in a camera file");
  if (!is_preset(text))
    throw bad_input(fmt::format("state: '{}' is neither a preset nor a JSON object; send one of them", row.key()));
}

/// Throws for surfaces from files, except those in `started`, the words with which the server was started.
void check_surfaces(const std::vector<std::string>& texts, const std::vector<std::string>& started) {
  const auto is_started = [&](const std::string& file) {
    return std::ranges::any_of(started,
                               [&](const std::string& word) { return word == file || word.starts_with(file + ":"); });
  };
  for (const std::string& text : texts) {
    // The longest name is tried first, because a file name may contain colons.
    for (std::size_t end = text.size(); end != std::string::npos && end > 0; end = text.rfind(':', end - 1))
      if (const std::string file = text.substr(0, end); names_surface_file(file) && !is_started(file))
        throw bad_input(
            "state: 'surface' takes no files from a page; send boundary or a block of the mesh, like "
            "boundary:COLOR:OPACITY");
  }
}

std::vector<std::string> client_words(const OptionRow& row, const Json& value, const OptionWords& base) {
  std::vector<std::string> words = json_words(row, value, row.key(), "state");
  check_texts(row, words);
  if (row.is(Trait::surfaces)) check_surfaces(words, base.words(row.key()));
  if (row.is(Trait::camera | Trait::function) && !words.empty()) check_no_file(row, words.front());
  return words;
}

}  // namespace
}  // namespace api

inline namespace v0_1 {

OptionWords state_words(const OptionWords& base, const nlohmann::json& state) {
  OptionWords words = base;
  if (state.contains("camera") && !state["camera"].is_null())
    for (const OptionRow* row : option_rows(Trait::view)) words.set(row->key(), std::vector<std::string>());
  for (const auto& [name, value] : state.items()) words.set(name, api::client_words(api::key_named(name), value, base));
  return words;
}

nlohmann::json state_of_words(const OptionWords& words) {
  nlohmann::json state = nlohmann::json::object();
  for (const auto& [name, values] : words.all()) {
    const OptionRow& row = *find_option(Trait::render, name);
    // A file was given when the server was started and applies to every state, so states do not contain it.
    const bool is_file = row.is(Trait::camera | Trait::function) && !is_json_text(values.front()) &&
                         !(row.is(Trait::function) && api::is_preset(values.front()));
    if (row.is(Trait::state) && !is_file) state[name] = api::json_of_words(row, values);
  }
  return state;
}

std::vector<std::string> arguments_of(const OptionWords& words) {
  std::vector<std::string> arguments;
  for (const auto& [name, values] : words.all()) {
    const OptionRow& row = *find_option(Trait::render, name);
    for (const std::string& value : values)
      arguments.push_back(row.is(Trait::flag | Trait::place) && value == "true" ? fmt::format("--{}", name)
                                                                                : fmt::format("--{}={}", name, value));
  }
  return arguments;
}

std::string shell_words(const std::vector<std::string>& arguments) {
  const auto is_plain = [](char c) {
    return is_letter(c) || is_digit(c) || std::string_view("-_=+:,./%@").find(c) != std::string_view::npos;
  };
  std::string line;
  for (const std::string& argument : arguments) {
    if (!line.empty()) line += ' ';
    if (!argument.empty() && std::ranges::all_of(argument, is_plain)) {
      line += argument;
      continue;
    }
    // Only the value is quoted, not the option's name, for readability.
    const std::size_t equals = argument.starts_with("--") ? argument.find('=') : std::string::npos;
    const std::size_t begin = equals == std::string::npos ? 0 : equals + 1;
    line.append(argument, 0, begin);
    line += '\'';
    for (const char c : argument.substr(begin)) {
      if (c == '\'') line += "'\\'";  // ends the quotes, adds an escaped quote, and begins them again
      line += c;
    }
    line += '\'';
  }
  return line;
}

}  // namespace v0_1
}  // namespace tessera
