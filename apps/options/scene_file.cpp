// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/scene_file.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/options/toml_text.hpp"
#include "apps/text_excerpt.hpp"
#include "tessera/error.hpp"
#include "tessera/input_file.hpp"
#include "tessera/program/nearest_name.hpp"

namespace tessera::apps {
namespace {

/// The option of a key; null if there is none.
CLI::Option* option_of(CLI::App& render, const std::string& key) {
  if (key == "input") return render.get_option("INPUT");
  if (key == "more") return render.get_option("MORE");
  return render.get_option_no_throw("--" + key);
}

Error no_key(const CLI::App& render, const std::string& file, const std::string& key) {
  if (key == "config") return bad_input(file + ": 'config' names another such file; leave it out");
  std::vector<std::string> names = {"input", "more"};
  for (const CLI::Option* option : render.get_options())
    names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
  const auto near = nearest_name(key, names);
  return bad_input(
      near ? fmt::format("{}: {} is no option of render; did you mean {}?", file, excerpt(key), *near)
           : fmt::format("{}: {} is no option of render; see tessera render --help-all", file, excerpt(key)));
}

std::string key_of(const CLI::Option& option) {
  if (!option.get_positional()) return option.get_lnames().front();
  return option.get_name(true) == "INPUT" ? "input" : "more";
}

}  // namespace

void add_scene_options(CLI::App& render, RenderWords& words) {
  render.add_option("--config", words.config, "TOML file of options; those of the command line win")->type_name("FILE");
  render.add_option("--save-config", words.save_config, "write what was given as such a file")->type_name("FILE");
}

std::vector<std::string> with_scene_file(const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments.front() != "render") return arguments;
  CommandLine given;  // what the command line says by itself, so that it wins
  try {
    std::vector<std::string> backwards(arguments.rbegin(), arguments.rend());
    given.app.parse(std::move(backwards));
  } catch (const CLI::RequiredError&) {  // the file may have it
  } catch (const CLI::Error&) {
    return arguments;  // for the parser that reports it
  }
  const std::string file = given.words.config;
  if (file.empty()) return arguments;
  std::vector<std::string> options, positionals;
  for (const auto& [key, values] : parse_toml(read_text(file), file)) {
    const CLI::Option* option = option_of(*given.render, key);
    if (option == nullptr || key == "config") throw no_key(*given.render, file, key);
    if (option->count() > 0) continue;
    for (const std::string& value : values) {
      if (option->get_positional())
        positionals.push_back(value);
      else if (value.empty() && option->get_expected_min() == 0)
        throw bad_input(fmt::format("{}: {} is empty; write true, or leave it out", file, excerpt(key)));
      else if (value.empty())
        options.insert(options.end(), {"--" + key, value});  // after a mere = CLI11 takes the next argument
      else if (option->get_expected_min() > 0)
        options.push_back(fmt::format("--{}={}", key, value));
      else if (value != "false")
        options.push_back(value == "true" ? "--" + key : fmt::format("--{}={}", key, value));
    }
  }
  std::vector<std::string> all = arguments;
  all.insert(all.begin() + 1, options.begin(), options.end());
  // The first positional is the input, wherever it stands.
  const bool has_input = given.render->get_option("INPUT")->count() > 0;
  all.insert(has_input ? all.end() : all.begin() + 1, positionals.begin(), positionals.end());
  return all;
}

std::string scene_text(const CLI::App& render) {
  std::string text = "# tessera render --config FILE\n";
  for (const CLI::Option* option : render.get_options()) {
    if (option->count() == 0) continue;
    const std::string key = key_of(*option);
    if (key == "config" || key == "save-config") continue;
    const std::vector<std::string>& values = option->results();
    std::string list;
    for (const std::string& value : values) list += (list.empty() ? "" : ", ") + toml_quoted(value);
    if (option->get_expected_min() == 0 && values.size() == 1 && values.front() == "true") list = "true";
    text += fmt::format("{} = {}\n", key, values.size() > 1 ? "[" + list + "]" : list);
  }
  return text;
}

}  // namespace tessera::apps
