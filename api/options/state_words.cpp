// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/program/state_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "api/options/surface_file_name.hpp"
#include "scene/quote.hpp"
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
    throw bad_input(fmt::format("state: {} is no key; did you mean {}?", scene::quote(name), *near));
  throw bad_input(fmt::format("state: {} is no key; docs/SERVER.md has those there are", scene::quote(name)));
}

Error wrong_kind(const std::string& name, const char* kind) {
  return bad_input(fmt::format("state: '{}' is no {}; send one", name, kind));
}

std::string text_of(const std::string& name, const Json& value) {
  if (value.is_number()) return value.dump();
  if (!value.is_string()) throw wrong_kind(name, "text or number");
  const auto& text = value.get_ref<const std::string&>();
  if (text.empty()) throw bad_input(fmt::format("state: '{}' is empty; leave it out, or give a value", name));
  constexpr std::size_t longest = 4096;
  if (text.size() > longest && !is_json_text(text))
    throw bad_input(fmt::format("state: '{}' has more than {} bytes; make it shorter", name, longest));
  if (std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }))
    throw bad_input(fmt::format("state: '{}' has control characters; leave them out", name));
  return text;
}

std::string camera_text(const std::string& name, const Json& value) {
  if (value.is_object()) return value.dump();
  std::string text = text_of(name, value);
  if (!is_json_text(text)) throw wrong_kind(name, "camera (a JSON object)");
  return text;
}

std::string function_text(const std::string& name, const Json& value) {
  if (value.is_object() || value.is_array()) return value.dump();
  std::string text = text_of(name, value);
  if (is_json_text(text)) return text;
  const std::vector<std::string> presets = preset_names();
  if (std::ranges::find(presets, text.substr(0, text.find(':'))) == presets.end())
    throw bad_input(fmt::format("state: '{}' is neither a preset nor a JSON object; send one of them", name));
  return text;
}

std::vector<std::string> list_of(const std::string& name, const Json& value) {
  if (!value.is_array()) return {text_of(name, value)};
  constexpr std::size_t most = 64;
  if (value.size() > most) throw bad_input(fmt::format("state: '{}' has more than {} values; send fewer", name, most));
  std::vector<std::string> texts;
  for (const Json& one : value) texts.push_back(text_of(name, one));
  return texts;
}

/// `started`: the words that the server was started with; their files may be shown again.
std::vector<std::string> state_surfaces(const std::string& name, const Json& value,
                                        const std::vector<std::string>& started) {
  std::vector<std::string> texts = list_of(name, value);
  const auto is_started = [&](const std::string& file) {
    return std::ranges::any_of(started,
                               [&](const std::string& word) { return word == file || word.starts_with(file + ":"); });
  };
  for (const std::string& text : texts) {
    // The longest name first: a file's may have colons.
    for (std::size_t end = text.size(); end != std::string::npos && end > 0; end = text.rfind(':', end - 1))
      if (const std::string file = text.substr(0, end); names_surface_file(file) && !is_started(file))
        throw bad_input(
            fmt::format("state: '{}' takes no files from a page; send boundary or a block of the mesh, like "
                        "boundary:COLOR:OPACITY",
                        name));
  }
  return texts;
}

std::vector<std::string> values_of(const OptionRow& row, const std::string& name, const Json& value,
                                   const OptionWords& base) {
  const bool is_flag = row.is(Trait::flag);
  if (value == true && (is_flag || row.is(Trait::place))) return {"true"};
  if (is_flag) throw wrong_kind(name, "true or false");
  if (row.is(Trait::surfaces)) return state_surfaces(name, value, base.words(name));
  if (row.is(Trait::list)) return list_of(name, value);
  if (row.is(Trait::camera)) return {camera_text(name, value)};
  if (row.is(Trait::function)) return {function_text(name, value)};
  return {text_of(name, value)};
}

}  // namespace
}  // namespace api

inline namespace v0_1 {

OptionWords state_words(const OptionWords& base, const nlohmann::json& state) {
  OptionWords words = base;
  if (state.contains("camera") && !state["camera"].is_null())
    for (const OptionRow* row : option_rows(Trait::view)) words.set(row->key(), std::vector<std::string>());
  for (const auto& [name, value] : state.items()) {
    const OptionRow& row = api::key_named(name);
    const bool is_given = !value.is_null() && value != false;
    words.set(name, is_given ? api::values_of(row, name, value, base) : std::vector<std::string>());
  }
  return words;
}

nlohmann::json state_of_words(const OptionWords& words) {
  nlohmann::json state = nlohmann::json::object();
  for (const auto& [name, values] : words.all()) {
    const OptionRow& row = *find_option(Trait::render, name);
    if (!row.is(Trait::state)) continue;
    const std::string& first = values.front();
    if (row.is(Trait::camera | Trait::function)) {
      try {
        state[name] = row.is(Trait::camera) ? api::camera_text(name, first) : api::function_text(name, first);
      } catch (const Error&) {  // a file: states that do not give another have it all the same
      }
    } else if (row.is(Trait::list)) {
      state[name] = values;
    } else if (row.is(Trait::flag) || (row.is(Trait::place) && first == "true")) {
      state[name] = true;
    } else {
      state[name] = first;
    }
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
    // The option's name outside of the quotes, for people.
    const std::size_t equals = argument.starts_with("--") ? argument.find('=') : std::string::npos;
    const std::size_t begin = equals == std::string::npos ? 0 : equals + 1;
    line.append(argument, 0, begin);
    line += '\'';
    for (const char c : argument.substr(begin)) {
      if (c == '\'') line += "'\\'";  // ends the quotes, says the mark, and begins them again
      line += c;
    }
    line += '\'';
  }
  return line;
}

}  // namespace v0_1
}  // namespace tessera
