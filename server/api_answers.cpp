// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "server/api.hpp"
#include "server/messages.hpp"
#include "tessera/error.hpp"
#include "tessera/presets.hpp"
#include "tessera/program/options.hpp"
#include "tessera/statistics.hpp"
#include "tessera/version.hpp"

namespace tessera::server {
namespace {

Json json_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

double encoded(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

const char* family_of(std::string_view preset) {
  if (preset == "cool-warm") return "diverging";
  if (preset == "turbo") return "rainbow";
  if (preset == "gray" || preset == "white") return "gray";
  return "sequential";
}

std::string hex_color(const glm::dvec3& color) {
  const auto byte = [](double c) { return static_cast<int>(std::lround(255 * std::clamp(c, 0.0, 1.0))); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(color.x), byte(color.y), byte(color.z));
}

Json presets_json() {
  constexpr std::size_t colors_shown = 33;
  Json presets = Json::array();
  for (const std::string& name : preset_names()) {
    Json colors = Json::array();
    for (const glm::dvec3& color : preset_colors(name, colors_shown)) colors.push_back(hex_color(color));
    presets.push_back({{"name", name}, {"family", family_of(name)}, {"colors", std::move(colors)}});
  }
  return presets;
}

Json fields_json(const Dataset& data) {
  Json fields = Json::array();
  for (const FieldInfo& field : data.fields())
    fields.push_back({{"name", field.name},
                      {"association", field.association == Association::cell ? "cell" : "point"},
                      {"components", field.components},
                      {"type", field.type},
                      {"range", {field.low, field.high}},
                      {"nan", field.nan_count},
                      {"active", field.active}});
  return fields;
}

Json counts_json(const Dataset& data) {
  if (data.is_grid()) return {{"blank", data.blank_samples()}};
  const MeshCounts& counts = data.mesh_counts();
  return {{"read", counts.cells_read},
          {"ghost", counts.cells_ghost},
          {"hidden", counts.cells_hidden},
          {"nan", counts.cells_nan},
          {"not_volumetric", counts.cells_not_volumetric},
          {"open", counts.cells_open},
          {"out_of_range", counts.cells_out_of_range},
          {"clipped", counts.cells_clipped},
          {"cut", counts.cells_cut}};
}

std::uint64_t cells_of(const Dataset& data) {
  if (data.is_mesh()) return data.mesh_counts().cells_read;
  std::uint64_t cells = 1;
  for (const auto samples : data.grid_geometry().samples())
    cells *= static_cast<std::uint64_t>(std::max<std::int64_t>(samples - 1, 1));
  return cells;
}

/// The state with all defaults filled in.
Json resolved(const ApiContext& context, const OpenScene& open) {
  const Dataset& data = open.held->data;
  const LoadedTransferFunction& loaded = context.stage.function(*open.held, *open.scene);
  const View view = open.scene->view(data);
  Json state = context.reader.base();
  state.update(open.state);
  state["camera"] = server::json_of(view.camera);
  for (const OptionRow* row : option_rows(Trait::view))
    if (row->key() != "camera") state.erase(std::string(row->key()));
  state["size"] = fmt::format("{}x{}", view.size.width, view.size.height);
  if (!data.shows_shape()) state["field"] = open.scene->field_word(data);
  const std::uint64_t steps = std::max<std::uint64_t>(data.time_steps(), context.reader.times().size());
  if (steps > 1 && !state.contains("time-step")) {
    const Json base = context.reader.base();  // for a series, the state includes the first step
    const auto begun_with = base.find("time-step");
    state["time-step"] = begun_with != base.end() ? *begun_with : Json(fmt::format("{}", steps - 1));
  }
  if (!state.contains("transfer-function")) {
    // The knots are those of the first image. They depend on how the field's values are distributed over the volume.
    for (const OptionRow* row : option_rows(Trait::knots)) {
      const std::string in_it(row->key());
      if (context.reader.fixes(in_it))
        state[in_it] = nullptr;
      else
        state.erase(in_it);
    }
    state["transfer-function"] = Json::parse(transfer_function_json(loaded.function));
    if (loaded.shaded && !state.contains("no-shade")) state["shade"] = true;
  } else if (loaded.range && !state.contains("range") && state["transfer-function"].is_string()) {
    state["range"] = fmt::format("{},{}", (*loaded.range)[0], (*loaded.range)[1]);
  }
  return state;
}

ProjectionKind projection_of(const Json& body, ProjectionKind otherwise) {
  const auto found = body.find("projection");
  if (found == body.end()) return otherwise;
  if (*found == "orthographic") return ProjectionKind::orthographic;
  if (*found == "perspective") return ProjectionKind::perspective;
  throw bad_input("projection: is unknown; use orthographic or perspective");
}

}  // namespace

Json json_of(const Camera& camera) { return Json::parse(camera_json({camera, std::nullopt})); }

bool is_logarithmic(const ApiContext& context, const OpenScene& open) {
  const auto entry = open.state.find("log");
  return entry == open.state.end() ? context.reader.fixes("log") : *entry == true;
}

Json data_answer(const ApiContext& context, const OpenScene& open) {
  const Dataset& data = open.held->data;
  std::vector<std::string> notes, warnings;
  for (const std::string& note : data.notes()) notes.push_back(context.reader.worded(note));
  for (const std::string& warning : data.warnings()) warnings.push_back(context.reader.worded(warning));
  std::vector<double> times = context.reader.times();
  if (times.empty()) times = {data.times().begin(), data.times().end()};
  const Box& box = data.bounds();
  return {{"file", context.reader.input_name()},
          {"format", data.format()},
          {"kind", data.is_mesh() ? "mesh" : "grid"},
          {"cells", cells_of(data)},
          {"tets", data.tet_count()},
          {"counts", counts_json(data)},
          {"bounds", {json_of(box.low), json_of(box.high)}},
          {"fields", fields_json(data)},
          {"field", data.shows_shape() ? Json() : Json(open.scene->field_word(data))},
          {"association", data.association() == Association::cell ? "cell" : "point"},
          {"range", data.range()},
          {"unit_distance", data.default_unit_distance()},
          {"time_steps", times.empty() ? data.time_steps() : times.size()},
          {"times", times.empty() ? Json() : Json(times)},
          {"blocks", data.blocks()},
          {"surfaces", data.surfaces()},
          {"notes", notes},
          {"warnings", warnings},
          {"ranks", context.stage.ranks()},
          {"threads", threads_for(context.threads)},
          {"tessera", version()},
          {"commit", commit()},
          {"presets", presets_json()},
          {"opacities", preset_opacity_names()},
          {"films", films_json()},
          {"defaults", resolved(context, open)}};
}

Json function_answer(const ApiContext& context, const OpenScene& open) {
  const Dataset& data = open.held->data;
  const LoadedTransferFunction& loaded = context.stage.function(*open.held, *open.scene);
  const std::span<const Knot> knots = loaded.function.knots();
  const double distance = loaded.unit_distance.value_or(data.default_unit_distance());
  const bool is_display = !open.scene->image_options().encode_srgb;
  Json colors = Json::array(), opacities = Json::array();
  for (const Knot& knot : knots) {
    Json color = {knot.value};
    for (int c = 0; c < 3; ++c) color.push_back(is_display ? knot.color[c] : encoded(knot.color[c]));
    colors.push_back(std::move(color));
    opacities.push_back({knot.value, -std::expm1(-knot.extinction * distance)});
  }
  const std::array<double, 2> range = loaded.range.value_or(std::array{knots.front().value, knots.back().value});
  return {{"range", range},
          {"name", context.reader.worded(loaded.name)},
          {"colors", std::move(colors)},
          {"opacities", std::move(opacities)},
          {"unit_distance", distance},
          {"log", is_logarithmic(context, open)},
          {"json", Json::parse(transfer_function_json(loaded.function))},
          {"paraview", Json::parse(paraview_json(loaded.function, distance, data.field_name()))},
          {"warnings", loaded.warnings}};
}

Json camera_answer(const OpenScene& open, const Json& body) {
  const Dataset& data = open.held->data;
  const View view = open.scene->view(data);
  const auto word = body.find("view");
  const std::string name = word == body.end() ? "default" : word->is_string() ? word->get<std::string>() : "";
  const ProjectionKind projection = projection_of(body, view.camera.projection);
  ViewRequest request;
  if (name == "fit") {
    request.fit = true;
    return json_of(adjusted_view(view.camera, data.bounds(), view.size, request));
  }
  if (name != "default") {
    const auto named = standard_view(name);
    if (!named)
      throw bad_input("view: is unknown; use front, back, left, right, top, bottom, iso, +x ... -z, default or fit");
    request.view = *named;
  }
  return json_of(data.view(request, view.size, projection));
}

}  // namespace tessera::server
