// SPDX-License-Identifier: BSD-3-Clause
#include "api/options/state_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "api/options/toml_text.hpp"
#include "tessera/error.hpp"
#include "tessera/program/nearest_name.hpp"
#include "tessera/program/options.hpp"
#include "tessera/program/text.hpp"
#include "tessera/state.hpp"
#include "tessera/view.hpp"

namespace tessera {
namespace api {
namespace {

using Json = nlohmann::json;

const OptionRow& row_named(std::string_view name, const std::string& source) {
  if (name == "config") throw bad_input(source + ": 'config' would read another such file; leave it out");
  const OptionRow* const row = find_option(Trait::render, name);
  const bool is_short = row != nullptr && name.size() == 1 && row->key() != name;
  if (row != nullptr && !is_short) return *row;
  std::vector<std::string> names;
  for (const OptionRow* each : option_rows(Trait::render)) names.emplace_back(each->key());
  if (const auto near = nearest_name(std::string(name), names))
    throw bad_input(fmt::format("{}: {} is not an option of render; did you mean {}?", source, quote(name), *near));
  throw bad_input(fmt::format("{}: {} is not an option of render; see tessera render --help-all", source, quote(name)));
}

/// Converts the values in a text file to words of the command line: a flag is "true", or has no word if it is false.
std::vector<std::string> words_of(const OptionRow& row, std::vector<std::string> values, std::string_view name,
                                  const std::string& source) {
  const bool is_flag = row.is(Trait::flag);
  if (!is_flag && !row.is(Trait::place)) {
    if (values.size() > 1 && !row.is(Trait::list))
      throw bad_input(fmt::format("{}: {} takes one value; give one", source, quote(name)));
    return values;
  }
  if (values.size() != 1 || values.front().empty())
    throw bad_input(fmt::format("{}: {} is empty; write true, or leave it out", source, quote(name)));
  if (values.front() == "false") return {};
  if (is_flag && values.front() != "true")
    throw bad_input(fmt::format("{}: {} is true or false, not {}", source, quote(name), quote(values.front())));
  return values;
}

void set_once(State& state, const OptionRow& row, std::vector<std::string> values, std::string_view name,
              const std::string& source) {
  if (state.words().contains(row.key()))
    throw bad_input(fmt::format("{}: {} is given twice, by two names; keep one", source, quote(name)));
  state.set(row.key(), std::move(values));
}

Error wrong_kind(std::string_view name, const char* kind, const std::string& source) {
  return bad_input(fmt::format("{}: {} is not {}; give one", source, quote(name), kind));
}

std::string text_of(const Json& value, std::string_view name, const std::string& source) {
  if (value.is_number()) return value.dump();
  if (!value.is_string()) throw wrong_kind(name, "text or a number", source);
  if (value.get_ref<const std::string&>().empty())
    throw bad_input(fmt::format("{}: {} is empty; leave it out, or give a value", source, quote(name)));
  return value.get<std::string>();
}

bool is_true(const OptionRow& row, const std::string& value) {
  return value == "true" && row.is(Trait::flag | Trait::place);
}

}  // namespace

std::vector<std::string> json_words(const OptionRow& row, const Json& value, std::string_view name,
                                    const std::string& source) {
  if (value.is_null() || value == false) return {};
  if (value == true && row.is(Trait::flag | Trait::place)) return {"true"};
  if (row.is(Trait::flag)) throw wrong_kind(name, "true or false", source);
  if (row.is(Trait::camera | Trait::function) && value.is_structured()) return {value.dump()};
  if (!row.is(Trait::list) || !value.is_array()) return {text_of(value, name, source)};
  std::vector<std::string> texts;
  texts.reserve(value.size());
  for (const Json& each : value) texts.push_back(text_of(each, name, source));
  return texts;
}

Json json_of_words(const OptionRow& row, const std::vector<std::string>& words) {
  if (row.is(Trait::list)) return words;
  if (is_true(row, words.front())) return true;
  return words.front();
}

}  // namespace api

inline namespace v0_1 {

State State::from_json(std::string_view text, const std::string& name) {
  const api::Json json = api::Json::parse(text, nullptr, false);
  if (!json.is_object())
    throw bad_input(name + R"(: is not a JSON object; write one, like {"field": "T", "size": "800x600"})");
  State state;
  for (const auto& [key, value] : json.items()) {
    const OptionRow& row = api::row_named(key, name);
    api::set_once(state, row, api::json_words(row, value, key, name), key, name);
  }
  return state;
}

State State::from_toml(std::string_view text, const std::string& name) {
  State state;
  for (api::TomlLine& line : api::parse_toml(text, name)) {
    const OptionRow& row = api::row_named(line.key, name);
    api::set_once(state, row, api::words_of(row, std::move(line.values), line.key, name), line.key, name);
  }
  return state;
}

std::string State::json() const {
  api::Json state = api::Json::object();
  for (const auto& [key, words] : words_) {
    const OptionRow& row = *find_option(Trait::render, key);
    api::Json value = api::json_of_words(row, words);
    if (row.is(Trait::camera | Trait::function) && is_json_text(words.front()))
      if (api::Json object = api::Json::parse(words.front(), nullptr, false); !object.is_discarded())
        value = std::move(object);
    try {
      (void)value.dump();
    } catch (const api::Json::type_error&) {
      throw bad_input(fmt::format("state: {} is not UTF-8, which JSON requires; write TOML instead", quote(key)));
    }
    state[key] = std::move(value);
  }
  return state.dump(2);
}

std::string State::toml() const {
  std::string text = "# tessera render --config FILE\n";
  for (const OptionRow* row : option_rows(Trait::render)) {
    const auto found = words_.find(row->key());
    if (found == words_.end() || row->key() == "save-config") continue;
    std::string list;
    for (const std::string& value : found->second) list += (list.empty() ? "" : ", ") + api::toml_quoted(value);
    if (api::is_true(*row, found->second.front())) list = "true";
    text += fmt::format("{} = {}\n", row->key(), found->second.size() > 1 ? "[" + list + "]" : list);
  }
  return text;
}

void State::set(std::string_view option, std::vector<std::string> values) {
  const OptionRow& row = api::row_named(option, "state");
  // An empty word means that there is no value, except for options with a list of texts.
  if (!row.is(Trait::list) && values.size() == 1 && values.front().empty()) values.clear();
  if (row.is(Trait::flag) && !values.empty()) values = api::words_of(row, std::move(values), option, "state");
  if (values.size() > 1 && !row.is(Trait::list))
    throw bad_input(fmt::format("state: {} takes one value; give one", quote(option)));
  if (values.empty())
    words_.erase(std::string(row.key()));
  else
    words_.insert_or_assign(std::string(row.key()), std::move(values));
}

}  // namespace v0_1
}  // namespace tessera
