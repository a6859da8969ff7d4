// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "server/api.hpp"
#include "server/messages.hpp"
#include "tessera/error.hpp"
#include "tessera/field_queries.hpp"

namespace tessera::server {
namespace {

Json place_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// Returns the value, or null if it is not finite, which JSON cannot represent.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json point_json(const std::optional<RayPoint>& point, const char* name) {
  const std::string prefix(name);
  if (!point) return {{prefix + "point", nullptr}, {prefix + "value", nullptr}, {prefix + "depth", nullptr}};
  return {{prefix + "point", place_json(point->position)},
          {prefix + "value", finite(point->value)},
          {prefix + "depth", finite(point->depth)}};
}

}  // namespace

Json histogram_answer(const ApiContext& context, const OpenScene& open, const Json& body) {
  HistogramOptions options;
  options.bins = static_cast<std::size_t>(whole_number(body, "bins", 256, 1, 4096));
  const auto visible = body.find("visible");
  if (visible != body.end() && *visible == true) options.seen = open.scene->view(open.held->data);
  options.logarithmic = is_logarithmic(context, open);
  const LoadedTransferFunction& loaded = context.stage.function(*open.held, *open.scene);
  if (loaded.range && (*loaded.range)[0] < (*loaded.range)[1] && body.contains("of_function"))
    options.range = loaded.range;
  const Histogram made = histogram(open.held->data, options);
  constexpr std::array fractions = {0.005, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.995};
  const std::vector<double> values = quantiles(open.held->data, fractions, options.seen);
  Json of_fractions = Json::object();
  for (std::size_t i = 0; i < fractions.size(); ++i) of_fractions[fmt::format("{}", fractions[i])] = finite(values[i]);
  return {{"range", made.range},
          {"counts", made.shares},
          {"log", made.logarithmic},
          {"outside", made.outside},
          {"quantiles", std::move(of_fractions)}};
}

Json probe_answer(const ApiContext& context, const OpenScene& open, const Json& body) {
  const View view = open.scene->view(open.held->data);
  const auto pixel = [&](const char* name, int side) {
    if (!body.contains(name)) throw bad_input(fmt::format("{}: is missing; give the pixel", name));
    return static_cast<int>(whole_number(body, name, 0, 0, side - 1));
  };
  const PixelIndex at{pixel("x", view.size.width), pixel("y", view.size.height)};
  const auto samples = static_cast<std::size_t>(whole_number(body, "samples", 256, 2, 4096));
  const LoadedTransferFunction& loaded = context.stage.function(*open.held, *open.scene);
  const RayProbe found = context.stage.probe(open.state, *open.scene, *open.held, view, at, samples);
  Json values = Json::array();
  for (const double value : found.value) values.push_back(finite(value));
  Json answer = point_json(found.first, "");
  answer.update(point_json(found.front, "front_"));
  answer.update(point_json(found.half, "half_"));
  answer["hit"] = found.first.has_value();
  answer["profile"] = {{"distance", found.depth}, {"value", std::move(values)}, {"opacity", found.opacity}};
  answer["rgba"] = {found.pixel.r, found.pixel.g, found.pixel.b, found.pixel.a};
  answer["range"] = loaded.range ? Json(*loaded.range) : Json();
  return answer;
}

}  // namespace tessera::server
