// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/state_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "apps/options/surface_file_name.hpp"
#include "apps/text_excerpt.hpp"
#include "tessera/dataset.hpp"
#include "tessera/error.hpp"
#include "tessera/program/nearest_name.hpp"
#include "tessera/program/text.hpp"
#include "tessera/view.hpp"

namespace tessera::apps {
namespace {

using Json = nlohmann::json;

enum class Kind {
  value,     ///< text or a number
  flag,      ///< true
  place,     ///< true, or text
  list,      ///< texts
  camera,    ///< an object, or its text
  function,  ///< likewise, or a list, or a preset's name
  surfaces,  ///< texts that name no file
};
struct StateKey {
  std::string_view name;
  Kind kind;
};
constexpr std::array state_keys = {StateKey{"size", Kind::value},
                                   StateKey{"camera", Kind::camera},
                                   StateKey{"view", Kind::value},
                                   StateKey{"up", Kind::value},
                                   StateKey{"azimuth", Kind::value},
                                   StateKey{"elevation", Kind::value},
                                   StateKey{"zoom", Kind::value},
                                   StateKey{"fit", Kind::flag},
                                   StateKey{"projection", Kind::value},
                                   StateKey{"field", Kind::value},
                                   StateKey{"time-step", Kind::value},
                                   StateKey{"block", Kind::list},
                                   StateKey{"smooth", Kind::flag},
                                   StateKey{"warp", Kind::value},
                                   StateKey{"drop-duplicates", Kind::flag},
                                   StateKey{"threshold", Kind::value},
                                   StateKey{"clip", Kind::list},
                                   StateKey{"transfer-function", Kind::function},
                                   StateKey{"rescale", Kind::flag},
                                   StateKey{"range", Kind::value},
                                   StateKey{"log", Kind::flag},
                                   StateKey{"opacity", Kind::value},
                                   StateKey{"opacity-points", Kind::value},
                                   StateKey{"unit-distance", Kind::value},
                                   StateKey{"blend", Kind::value},
                                   StateKey{"emission", Kind::value},
                                   StateKey{"iso", Kind::list},
                                   StateKey{"surface", Kind::surfaces},
                                   StateKey{"shade", Kind::flag},
                                   StateKey{"no-shade", Kind::flag},
                                   StateKey{"light", Kind::value},
                                   StateKey{"background", Kind::value},
                                   StateKey{"color-bar", Kind::place},
                                   StateKey{"color-bar-title", Kind::value},
                                   StateKey{"color-bar-range", Kind::value},
                                   StateKey{"color-bar-scale", Kind::value},
                                   StateKey{"field-unit", Kind::value},
                                   StateKey{"axes", Kind::place},
                                   StateKey{"outline", Kind::flag},
                                   StateKey{"scale-bar", Kind::place},
                                   StateKey{"length-unit", Kind::value},
                                   StateKey{"annotate", Kind::list},
                                   StateKey{"annotation-color", Kind::value},
                                   StateKey{"annotation-size", Kind::value},
                                   StateKey{"accuracy", Kind::value},
                                   StateKey{"integrator", Kind::value},
                                   StateKey{"step", Kind::value},
                                   StateKey{"half", Kind::flag},
                                   StateKey{"png-bits", Kind::value}};

/// What a camera says, so that it takes the place of them.
constexpr std::array<std::string_view, 9> view_options = {"camera", "view", "up",         "azimuth", "elevation",
                                                          "zoom",   "fit",  "projection", "orbit"};

const StateKey& key_named(const std::string& name) {
  const auto* const found = std::ranges::find(state_keys, std::string_view(name), &StateKey::name);
  if (found != state_keys.end()) return *found;
  std::vector<std::string> names;
  names.reserve(state_keys.size());
  for (const StateKey& key : state_keys) names.emplace_back(key.name);
  if (const auto near = nearest_name(name, names))
    throw bad_input(fmt::format("state: {} is no key; did you mean {}?", excerpt(name), *near));
  throw bad_input(fmt::format("state: {} is no key; docs/SERVER.md has those there are", excerpt(name)));
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

/// `started`: the words that the server was started with, or null; their files may be shown again.
std::vector<std::string> surfaces_of(const std::string& name, const Json& value,
                                     const std::vector<std::string>* started) {
  std::vector<std::string> texts = list_of(name, value);
  const auto is_started = [started](const std::string& file) {
    return started != nullptr && std::ranges::any_of(*started, [&](const std::string& word) {
             return word == file || word.starts_with(file + ":");
           });
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

std::vector<std::string> values_of(const StateKey& key, const std::string& name, const Json& value,
                                   const OptionWords& base) {
  if (value == true && (key.kind == Kind::flag || key.kind == Kind::place)) return {"true"};
  switch (key.kind) {
    case Kind::flag:
      throw wrong_kind(name, "true or false");
    case Kind::list:
      return list_of(name, value);
    case Kind::surfaces:
      return surfaces_of(name, value, find_words(base, name));
    case Kind::camera:
      return {camera_text(name, value)};
    case Kind::function:
      return {function_text(name, value)};
    default:
      return {text_of(name, value)};
  }
}

}  // namespace

const std::vector<std::string>* find_words(const OptionWords& words, const std::string& option) {
  const auto found = std::ranges::find(words, option, &OptionWords::value_type::first);
  return found == words.end() ? nullptr : &found->second;
}

OptionWords state_words(const OptionWords& base, const Json& state) {
  OptionWords words;
  const bool has_camera = state.contains("camera") && !state["camera"].is_null();
  for (const auto& option : base) {
    if (state.contains(option.first)) continue;
    if (has_camera && std::ranges::find(view_options, std::string_view(option.first)) != view_options.end()) continue;
    words.push_back(option);
  }
  for (const auto& [name, value] : state.items()) {
    const StateKey& key = key_named(name);
    if (value.is_null() || value == false) continue;
    std::vector<std::string> values = values_of(key, name, value, base);
    if (!values.empty()) words.emplace_back(name, std::move(values));
  }
  std::ranges::sort(words, {}, &OptionWords::value_type::first);
  return words;
}

Json state_of_words(const OptionWords& words) {
  Json state = Json::object();
  for (const auto& [name, values] : words) {
    const auto* const key = std::ranges::find(state_keys, std::string_view(name), &StateKey::name);
    if (key == state_keys.end() || values.empty()) continue;
    const std::string& first = values.front();
    const bool is_flag = key->kind == Kind::flag || (key->kind == Kind::place && first == "true");
    if (key->kind == Kind::camera || key->kind == Kind::function) {
      try {
        state[name] = key->kind == Kind::camera ? Json(camera_text(name, first)) : Json(function_text(name, first));
      } catch (const Error&) {  // a file: states that say nothing have it all the same
      }
    } else if (key->kind == Kind::list || key->kind == Kind::surfaces) {
      state[name] = values;
    } else {
      state[name] = is_flag ? Json(true) : Json(first);
    }
  }
  return state;
}

std::vector<std::string> arguments_of(const OptionWords& words) {
  std::vector<std::string> arguments;
  for (const auto& [name, values] : words) {
    const auto* const key = std::ranges::find(state_keys, std::string_view(name), &StateKey::name);
    // Others are of the server's command line; flags among them have the value true alone.
    const bool may_be_bare = key == state_keys.end() || key->kind == Kind::flag || key->kind == Kind::place;
    for (const std::string& value : values)
      arguments.push_back(may_be_bare && value == "true" ? fmt::format("--{}", name)
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

}  // namespace tessera::apps
