// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "api/options/toml_text.hpp"
#include "scene/quote.hpp"
#include "tessera/error.hpp"
#include "tessera/input_file.hpp"
#include "tessera/program/nearest_name.hpp"
#include "tessera/program/render_options.hpp"

namespace tessera {
namespace api {
namespace {

Error no_key(const std::string& file, const std::string& key) {
  if (key == "config") return bad_input(file + ": 'config' names another such file; leave it out");
  std::vector<std::string> names;
  for (const OptionRow* row : option_rows(Trait::render)) names.emplace_back(row->key());
  const auto near = nearest_name(key, names);
  return bad_input(
      near ? fmt::format("{}: {} is no option of render; did you mean {}?", file, scene::quote(key), *near)
           : fmt::format("{}: {} is no option of render; see tessera render --help-all", file, scene::quote(key)));
}

/// The values of a key as the command line has them: a flag's is true, or none if it is false.
std::vector<std::string> config_values(const OptionRow& row, const TomlLine& line, const std::string& file) {
  const bool is_flag = row.is(Trait::flag);
  if (!is_flag && !row.is(Trait::place)) {
    if (line.values.size() > 1 && !row.is(Trait::list))
      throw bad_input(fmt::format("{}: {} takes one value; give one", file, scene::quote(line.key)));
    return line.values;
  }
  if (line.values.size() != 1 || line.values.front().empty())
    throw bad_input(fmt::format("{}: {} is empty; write true, or leave it out", file, scene::quote(line.key)));
  const std::string& value = line.values.front();
  if (value == "false") return {};
  if (is_flag && value != "true")
    throw bad_input(fmt::format("{}: {} is true or false, not {}", file, scene::quote(line.key), scene::quote(value)));
  return {value};
}

}  // namespace
}  // namespace api

inline namespace v0_1 {

void apply_config(const std::filesystem::path& file, OptionWords& words) {
  const std::string name = file.string();
  OptionWords config;
  for (const api::TomlLine& line : api::parse_toml(read_text(name), name)) {
    const OptionRow* const row = find_option(Trait::render, line.key);
    const bool is_short = row != nullptr && line.key.size() < row->key().size() && line.key.size() == 1;
    if (row == nullptr || is_short || line.key == "config") throw api::no_key(name, line.key);
    if (config.given(row->key()))
      throw bad_input(fmt::format("{}: {} is given twice, by two names; keep one", name, scene::quote(line.key)));
    config.set(row->key(), api::config_values(*row, line, name));
  }
  for (const auto& [key, values] : config.all())
    if (!words.given(key)) words.set(key, values);
}

std::string config_text(const OptionWords& words) {
  std::string text = "# tessera render --config FILE\n";
  for (const OptionRow* row : option_rows(Trait::render)) {
    const std::vector<std::string>& values = words.words(row->key());
    if (values.empty() || row->key() == "config" || row->key() == "save-config") continue;
    std::string list;
    for (const std::string& value : values) list += (list.empty() ? "" : ", ") + api::toml_quoted(value);
    if (row->is(Trait::flag | Trait::place) && values.front() == "true") list = "true";
    text += fmt::format("{} = {}\n", row->key(), values.size() > 1 ? "[" + list + "]" : list);
  }
  return text;
}

}  // namespace v0_1
}  // namespace tessera
