// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/like_report.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>

#include "tessera/dataset.hpp"
#include "tessera/error.hpp"
#include "tessera/input_file.hpp"

namespace tessera::apps {
namespace {

using Json = nlohmann::json;

/// The views of all frames, each once: those of a time series are of every step.
Json views_of(const Json& report) {
  Json views = Json::array();
  for (const Json& frame : report.at("frames"))
    if (const auto view = frame.find("view"); view != frame.end() && std::ranges::find(views, *view) == views.end())
      views.push_back(*view);
  return views;
}

/// The word for --field; none if the report's data have a single field.
std::string field_of(const Json& data) {
  const Json &field = data.at("field"), &fields = data.at("fields");
  const auto name = field.at("name").get<std::string>();
  if (fields.size() < 2 || name == shape_field_name) return {};
  const auto namesakes = std::ranges::count_if(fields, [&](const Json& each) { return each.at("name") == name; });
  return namesakes > 1 ? field.at("association").get<std::string>() + ":" + name : name;
}

std::string light_words(const Json& light) {
  const Json& d = light.at("direction");
  return fmt::format("{}{},{},{}", light.at("frame") == "world" ? "world:" : "", d.at(0).get<double>(),
                     d.at(1).get<double>(), d.at(2).get<double>());
}

}  // namespace

void add_like_option(CLI::App& render, RenderWords& words) {
  render
      .add_option("--like", words.like,
                  "report of another run: its views, size, field and transfer function; options beside it win")
      ->type_name("REPORT");
}

void apply_like(const CLI::App& render, RenderWords& words) {
  if (words.like.empty()) return;
  const std::string text = read_text(words.like);
  check_json(text, words.like);
  const auto is_given = [&](std::initializer_list<const char*> options) {
    return std::ranges::any_of(options, [&](const char* option) { return render.get_option(option)->count() > 0; });
  };
  try {
    const Json report = Json::parse(text);
    const Json& data = report.at(report.contains("mesh") ? "mesh" : "volume");
    const Json& function = report.at("transfer_function");
    const Json& method = report.at("method");
    const Json views = views_of(report);
    if (views.empty()) throw bad_input(fmt::format("{}: no frame was rendered; give another report", words.like));
    if (!is_given({"--camera", "--view", "--up", "--azimuth", "--elevation", "--zoom", "--projection"}))
      words.camera = views.dump();
    if (!is_given({"--field"})) words.field = field_of(data);
    if (!is_given({"--transfer-function", "--opacity-points", "--log"})) {
      words.transfer_function = Json{{"knots", function.at("knots")}}.dump();
      if (!is_given({"--blend"})) words.blend = method.at("blend").get<std::string>();
      if (!is_given({"--emission"})) words.emission = method.at("emission").get<std::string>();
      if (is_given({"--shade", "--no-shade", "--light"})) return;
      words.shade = method.at("shade").get<bool>();
      if (words.shade) words.light = light_words(method.at("light"));
    }
  } catch (const Json::exception&) {
    throw bad_input(fmt::format("{}: it is no report of a run; give a file that --report has written", words.like));
  }
}

}  // namespace tessera::apps
