// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/reports.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>
#include <utility>

#include "tessera/version.hpp"
#include "tessera/view.hpp"

namespace tessera::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const glm::dvec3& v) { return {v.x + 0.0, v.y + 0.0, v.z + 0.0}; }  // adding 0 makes -0 a 0

Json fields_json(const Description& data) {
  Json fields = Json::array();
  for (const auto& field : data.fields)
    fields.push_back({{"name", field.name},
                      {"association", word(field.association)},
                      {"components", field.components},
                      {"type", field.type},
                      {"range", {field.low, field.high}},
                      {"nan", field.nan_count}});
  return fields;
}

Json tally_json(const Verification::Tally& tally) {
  return {{"pixels", tally.pixels},
          {"max_error", tally.max_error},
          {"over_bound", tally.over_bound},
          {"excused", tally.excused}};
}

Json finding_json(const MeshCheck::Finding& finding) {
  Json places = Json::array();
  for (const auto& place : finding.places) {
    Json json = {{"id", place.cell}};
    if (place.other != place.cell) json["other"] = place.other;
    json["at"] = {place.at.x, place.at.y, place.at.z};
    if (place.value > 0) json["value"] = place.value;
    places.push_back(json);
  }
  return {{"count", finding.count}, {"places", places}};
}

Json mesh_counters_json(const FrameStatistics& statistics) {
  Json json;
  for (const FrameCounter& counter : frame_counters)
    if (const std::uint64_t count = statistics.mesh.*counter.member; count > 0 || !counter.if_any)
      json[std::string(counter.name)] = count;
  return json;
}

Json counters_of(const GridCounters& counters) {
  Json json;
  for (const GridCounter& counter : grid_counters)
    if (const std::uint64_t count = counters.*counter.member; count > 0 || !counter.if_any)
      json[std::string(counter.name)] = count;
  return json;
}

Json grid_counters_json(const FrameStatistics& statistics) {
  Json json = counters_of(statistics.grid);
  if (statistics.mesh.deep_samples > 0) json["deep_samples"] = statistics.mesh.deep_samples;
  return json;
}

/// Adds the counters by group, without empty groups.
void add_counters_of(const MeshCounts& counts, Json& json) {
  const auto group_of = [](const MeshCounter& counter) { return counter.name.substr(0, counter.name.find('/')); };
  for (const MeshCounter& counter : mesh_counters) {
    const bool is_relevant = std::ranges::any_of(mesh_counters, [&](const MeshCounter& other) {
      return group_of(other) == group_of(counter) && (!other.if_any || counts.*other.member > 0);
    });
    if (!counter.name.empty() && is_relevant)
      json[Json::json_pointer("/" + std::string(counter.name))] = counts.*counter.member;
  }
}

Json higher_order_json(const Description& data) {
  Json json;
  for (const HigherOrderCounter& counter : higher_order_counters)
    json[std::string(counter.name)] = data.higher_order.*counter.member;
  for (const HigherOrderBound& bound : higher_order_bounds)
    json[std::string(bound.name)] = data.higher_order.*bound.member;
  if (data.higher_order_pixels > 0)
    json["pixel_error"] = data.higher_order_pixels;  // infinity becomes null: there is
                                                     // no bound
  return json;
}

}  // namespace

const char* word(Association association) { return association == Association::point ? "point" : "cell"; }

const char* word(Balance balance) {
  constexpr std::array words = {"learned", "accurate", "backface", "splatting", "previous", "even"};
  return words[static_cast<std::size_t>(balance)];
}

Description::Description(const Dataset& data)
    : is_mesh(data.is_mesh()),
      format(data.format()),
      field_name(data.field_name()),
      association(data.association()),
      box(data.bounds()),
      range(data.range()),
      fields(data.fields().begin(), data.fields().end()),
      notes(data.notes().begin(), data.notes().end()),
      warnings(data.warnings()),
      blocks(data.blocks().begin(), data.blocks().end()),
      counts(data.mesh_counts()),
      higher_order(data.higher_order_cells()),
      scale(data.scale()),
      shift(data.shift()),
      blanks(data.blank_samples()) {
  if (is_mesh) return;
  geometry = data.grid_geometry();
  type = data.sample_type();
}

Json program_json() {
  return {{"program", "tessera"}, {"version", version()}, {"commit", commit()}, {"build", build_facts()}};
}

Json data_json(const std::filesystem::path& input, const Description& data) {
  Json json = {{"file", input.string()}, {"format", data.format}};
  if (data.is_mesh) {
    add_counters_of(data.counts, json);
    if (data.counts.cells_quadratic > 0) json["higher_order"] = higher_order_json(data);
  } else {
    const GridGeometry& g = data.geometry;
    json["points"] = g.points;
    json["rectilinear"] = g.rectilinear();
    json["origin"] = vector_json(g.origin);
    json["spacing"] = vector_json(g.spacing);
    json["direction"] = {vector_json(g.direction[0]), vector_json(g.direction[1]), vector_json(g.direction[2])};
  }
  json["bounds"] = {vector_json(data.box.low), vector_json(data.box.high)};
  if (!data.is_mesh) {
    json["type"] = name_of(data.type);
    json["scale"] = data.scale;
    json["shift"] = data.shift;
  }
  json["field"] = {{"name", data.field_name}, {"association", word(data.association)}, {"range", data.range}};
  if (!data.is_mesh) json["field"]["blank"] = data.blanks;
  json["fields"] = fields_json(data);
  if (!data.blocks.empty()) json["blocks"] = data.blocks;
  json["notes"] = data.notes;
  json["warnings"] = data.warnings;
  return json;
}

Json transfer_function_json(const LoadedTransferFunction& loaded) {
  Json knots = Json::array();
  for (const auto& knot : loaded.function.knots())
    knots.push_back({knot.value, knot.color.x, knot.color.y, knot.color.z, knot.extinction});
  Json json = {{"name", loaded.name}};
  if (loaded.range) json["range"] = *loaded.range;
  if (!loaded.warnings.empty()) json["warnings"] = loaded.warnings;
  if (loaded.unit_distance)
    json["unit_distance"] = {{"value", *loaded.unit_distance}, {"source", loaded.unit_distance_source}};
  json["knots"] = knots;
  return json;
}

Json view_json(const Camera& camera, ImageSize size) { return Json::parse(tessera::camera_json({camera, size})); }

double deviation(const std::vector<double>& work) {
  const double sum = std::accumulate(work.begin(), work.end(), 0.0);
  if (!(sum > 0)) return 0;
  const auto [least, most] = std::minmax_element(work.begin(), work.end());
  return (*most - *least) * static_cast<double>(work.size()) / sum;
}

Json counters_json(const FrameStatistics& statistics, bool is_grid) {
  return is_grid ? grid_counters_json(statistics) : mesh_counters_json(statistics);
}

Json balance_json(Balance balance, const FrameStatistics& statistics) {
  Json processes = Json::array();
  std::vector<double> cpu = statistics.cpu_seconds;
  for (std::size_t rank = 0; rank < cpu.size(); ++rank) cpu[rank] += statistics.split_cpu_seconds[rank];
  for (std::size_t rank = 0; rank < statistics.samples.size(); ++rank) {
    const PixelRect& r = statistics.rectangles[rank];
    processes.push_back({{"rectangle", {r.x0, r.y0, r.x1, r.y1}},
                         {"samples", statistics.samples[rank]},
                         {"cpu_ms", 1e3 * statistics.cpu_seconds[rank]},
                         {"split_cpu_ms", 1e3 * statistics.split_cpu_seconds[rank]},
                         {"counters", counters_of(statistics.ranks[rank])}});
    if (!statistics.parts.empty()) processes.back()["part"] = statistics.parts[rank];
  }
  return {{"method", statistics.parts.empty() ? word(balance) : "sort-last"},
          {"samples_deviation", deviation({statistics.samples.begin(), statistics.samples.end()})},
          {"cpu_deviation", deviation(cpu)},
          {"rendering_cpu_deviation", deviation(statistics.cpu_seconds)},
          {"processes", processes}};
}

Json verification_json(const Verification& v) {
  Json json = {{"pixels", v.pixels_checked},
               {"max_error", v.max_error},
               {"rms_error", v.rms_error},
               {"max_error_not_excused", v.max_error_not_excused},
               {"worst_pixel", {v.worst_x, v.worst_y}},
               {"worst_value", v.worst_value},
               {"worst_reference", v.worst_reference},
               {"worst_chosen", v.worst_reason},
               {"over_bound", v.over_bound},
               {"excused", v.excused},
               {"met", v.met},
               {"random", tally_json(v.tallies.front())}};
  Json chosen = Json::object();
  for (const Verification::Tally& tally : std::span(v.tallies).subspan(1)) chosen[tally.reason] = tally_json(tally);
  json["chosen"] = std::move(chosen);
  if (v.bound) json["bound"] = *v.bound;
  if (!v.layers.empty()) {
    Json layers = Json::array();
    for (const Verification::Tally& layer : v.layers) layers.push_back(tally_json(layer));
    json["layers"] = {{"bound", v.layer_bound}, {"met", v.layers_met}, {"layers", std::move(layers)}};
  }
  return json;
}

Json check_json(const MeshCheck& check) {
  Json json = {{"tets", check.tets}, {"points", check.points}, {"clean", check.clean()}};
  json["overlaps"] = finding_json(check.overlaps);
  json["overlaps"]["cells"] = check.overlapping_cells;
  json["overlaps"]["more"] = check.more_overlaps;
  json["folded"] = finding_json(check.inverted);
  json["non_conforming_faces"] = finding_json(check.non_conforming_faces);
  json["flat"] = finding_json(check.flat);
  json["slivers"] = finding_json(check.slivers);
  json["slivers"]["above_1e4"] = check.slivers_1e4;
  json["slivers"]["above_1e6"] = check.slivers_1e6;
  json["slivers"]["worst_aspect"] = check.worst_aspect;
  json["duplicate_points"] = finding_json(check.duplicate_points);
  json["right_handed"] = check.right_handed;
  json["left_handed"] = check.left_handed;
  return json;
}

}  // namespace tessera::analysis
