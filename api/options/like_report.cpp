// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "tessera/dataset.hpp"
#include "tessera/error.hpp"
#include "tessera/input_file.hpp"
#include "tessera/program/render_options.hpp"

namespace tessera {
namespace api {
namespace {

using Json = nlohmann::json;

/// The views of all frames, each once. In a time series the same views apply to every step.
Json report_views(const Json& report) {
  Json views = Json::array();
  for (const Json& frame : report.at("frames"))
    if (const auto view = frame.find("view"); view != frame.end() && std::ranges::find(views, *view) == views.end())
      views.push_back(*view);
  return views;
}

/// The value for --field; none if the report's data have a single field.
std::string report_field(const Json& data) {
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
}  // namespace api

inline namespace v0_1 {

void apply_like(OptionWords& words) {
  if (!words.given("like")) return;
  const std::string& file = words.word("like");
  const std::string text = read_text(file);
  check_json(text, file);
  using Json = nlohmann::json;
  try {
    const Json report = Json::parse(text);
    const Json& data = report.at(report.contains("mesh") ? "mesh" : "volume");
    const Json& function = report.at("transfer_function");
    const Json& method = report.at("method");
    const Json views = api::report_views(report);
    if (views.empty()) throw bad_input(fmt::format("{}: no frame was rendered; give another report", file));
    if (!words.given_one_of({"camera", "view", "up", "azimuth", "elevation", "zoom", "projection"}))
      words.set("camera", views.dump());
    words.set_default("field", api::report_field(data));
    if (words.given_one_of({"transfer-function", "opacity-points", "log"})) return;
    words.set("transfer-function", Json{{"knots", function.at("knots")}}.dump());
    if (function.value("scale", "") == "log" && words.given("color-bar") && !words.given("color-bar-range"))
      words.set_default("color-bar-scale", "log");
    words.set_default("blend", method.at("blend").get<std::string>());
    words.set_default("emission", method.at("emission").get<std::string>());
    if (words.given_one_of({"shade", "no-shade", "light"}) || !method.at("shade").get<bool>()) return;
    words.set("shade", "true");
    words.set("light", api::light_words(method.at("light")));
  } catch (const Json::exception&) {
    throw bad_input(fmt::format("{}: it is not a report of a run; give a file that `report` has written", file));
  }
}

}  // namespace v0_1
}  // namespace tessera
