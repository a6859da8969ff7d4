// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <utility>

#include "apps/stderr_lines.hpp"
#include "tessera/program/options.hpp"

namespace tessera::apps {
namespace {

using analysis::Description;
using analysis::deviation;
using analysis::word;
using Json = nlohmann::ordered_json;

const char* word(Rasterizer rasterizer) {
  return rasterizer == Rasterizer::planes ? "planes" : rasterizer == Rasterizer::scanline ? "scanline" : "device";
}

std::string method_words(const Settings& settings) {
  std::string words = method_word(settings.integrator.kind);
  if (settings.integrator.kind == IntegratorKind::automatic)
    words += fmt::format(" to {:g}", settings.integrator.accuracy);
  if (takes_steps(settings.integrator)) words += fmt::format(" every {:g} voxels", settings.grid.step);
  if (settings.grid.shading) words += ", shaded";
  return words;
}

/// Text that describes how the work was shared between ranks, if there are several.
std::string balance_words(const RenderOptions& options, const FrameRecord& record) {
  const auto& by_rank = record.statistics.samples;
  if (by_rank.size() < 2) return {};
  const std::vector<double> samples(by_rank.begin(), by_rank.end());
  const bool sorts_last = !record.statistics.parts.empty();
  return fmt::format(", {} processes {}: samples per process differ by {:.1f} % of their mean", samples.size(),
                     sorts_last ? "sort-last" : fmt::format("by {}", word(options.settings.ranks.balance)),
                     100 * deviation(samples));
}

}  // namespace

Description described(const Dataset& data) {
  Description description(data);
  description.notes = with_options(description.notes);
  description.warnings = with_options(description.warnings);
  return description;
}

namespace {

Json iso_json(const Surfaces& surfaces) {
  Json json = Json::array();
  for (const IsoSurface& iso : surfaces.iso) {
    json.push_back({{"value", iso.value}, {"opacity", iso.opacity}});
    if (iso.color) json.back()["color"] = {iso.color->x, iso.color->y, iso.color->z};
  }
  return json;
}

Json faces_json(const Surfaces& surfaces, std::span<const BlockSurfaceWord> blocks) {
  Json json = Json::array();
  const auto add = [&](const std::string& what, const std::optional<glm::dvec3>& color, double opacity) {
    json.push_back({{"what", what}, {"opacity", opacity}});
    if (color) json.back()["color"] = {color->x, color->y, color->z};
  };
  for (const BoundarySurface& boundary : surfaces.boundary) add("boundary", boundary.color, boundary.opacity);
  for (const TriangleSurface& surface : surfaces.triangles)
    add(fmt::format("{} triangles", surface.mesh->triangles.size()), surface.color, surface.opacity);
  for (const BlockSurfaceWord& block : blocks) add("block " + block.name, block.color, block.opacity);
  return json;
}

void add_shading(const std::optional<Shading>& shading, Json& json) {
  json["shade"] = shading.has_value();
  if (shading)
    json["light"] = {{"frame", shading->camera_light ? "camera" : "world"},
                     {"direction", {shading->to_light.x, shading->to_light.y, shading->to_light.z}}};
}

Json mesh_method_json(const RenderOptions& options) {
  const Settings& settings = options.settings;
  Json json = {{"integrator", method_line(settings.integrator)}};
  if (settings.integrator.kind == IntegratorKind::automatic) json["accuracy"] = settings.integrator.accuracy;
  json["emission"] = settings.emission == Emission::absorption ? "absorption" : "independent";
  add_shading(settings.mesh.shading, json);
  if (!settings.surfaces.iso.empty()) json["iso"] = iso_json(settings.surfaces);
  if (settings.surfaces.has_faces() || !options.block_surfaces.empty())
    json["surface"] = faces_json(settings.surfaces, options.block_surfaces);
  if (options.frame.deep && !options.frame.peel) json["deep_accuracy"] = options.frame.deep_accuracy;
  json["rasterizer"] = word(settings.mesh.rasterizer);
  const DeviceSettings& on = settings.mesh.device;
  const bool fragment = on.method == GlMethod::fragment;
  json["compositor"] = on.backends.empty() ? "cpu" : fragment ? "gl-fragment" : "gl-compute";
  if (!on.backends.empty() && fragment) json["framebuffer"] = on.half ? "half" : "float";
  if (options.words.given("without")) json["without"] = options.words.word("without");
  json["blend"] = options.function.display_colors ? "display" : "linear";
  json["threads"] = settings.threads;  // 0: all cores
  json["tile_size"] = settings.mesh.tile_size;
  json["memory_bytes"] = settings.memory_bytes;
  return json;
}

Json grid_method_json(const RenderOptions& options, int ranks) {
  const Settings& settings = options.settings;
  const GridSettings& s = settings.grid;
  Json json = {{"integrator", method_word(settings.integrator.kind)}};
  if (settings.integrator.kind == IntegratorKind::automatic) json["accuracy"] = settings.integrator.accuracy;
  if (takes_steps(settings.integrator)) json["step"] = s.step;
  json["emission"] = settings.emission == Emission::absorption ? "absorption" : "independent";
  add_shading(s.shading, json);
  json["backend"] = "cpu";
  if (options.words.given("without")) json["without"] = options.words.word("without");
  json["blend"] = options.function.display_colors ? "display" : "linear";
  json["threads"] = settings.threads;
  json["brick_size"] = s.brick_size;
  json["edge_bricks"] = s.edge_bricks == EdgeBricks::variable ? "variable" : "fixed";
  json["cache"] = s.cache == CachePolicy::lru ? "lru" : "proximity";
  json["preload"] = s.preload_limit;
  json["memory_bytes"] = settings.memory_bytes;
  json["ranks"] = ranks;
  if (settings.ranks.distribution == Distribution::sort_last) {
    const bool waits = settings.ranks.direct_send == DirectSend::synchronous;
    json["distribution"] = "sort-last";
    json["direct_send"] = waits ? "synchronous" : "asynchronous";
    return json;
  }
  json["distribution"] = "sort-first";
  json["balance"] = {
      {"method", word(settings.ranks.balance)},
      {"resolution", settings.ranks.balance_resolution},
      {"weights", settings.ranks.balance_measured ? Json("measured") : Json(settings.ranks.balance_weights)}};
  return json;
}

}  // namespace

Json method_json(const RenderOptions& options, int ranks) {
  Json json = options.is_grid() ? grid_method_json(options, ranks) : mesh_method_json(options);
  if (const auto& peel = options.frame.peel) json["peel"] = {{"threshold", peel->threshold}, {"layers", peel->layers}};
  for (const OptionRow* row : option_rows(Trait::annotation)) {
    const auto& given = options.words.words(row->key());
    if (!given.empty())
      json["annotation"][std::string(row->key())] = row->is(Trait::list) ? Json(given) : Json(given.back());
  }
  return json;
}

Json job_json(const RenderOptions& options, int ranks, const Roles& roles) {
  constexpr std::array partitions = {"file", "curve", "random"};
  const RankSettings& settings = options.settings.ranks;
  return {{"ranks", ranks},
          {"projectors", roles.projectors},
          {"compositors", roles.compositors},
          {"exchange", exchange_word(exchange_of(options.settings, options.frame.deep || options.frame.peel))},
          {"partition", partitions[static_cast<std::size_t>(settings.partition.kind)]},
          {"frames_in_flight", settings.frames_in_flight},
          {"seed", settings.tile_seed}};
}

InDoublePrecision in_double_precision(const FrameStatistics& statistics, bool is_grid) {
  if (is_grid) return {statistics.grid.pixels_again, statistics.grid.rays};
  return {statistics.mesh.segments_in_double_precision, statistics.mesh.segments};
}

Json frame_json(const RenderOptions& options, const FilmFrame& frame, const FrameRecord* record) {
  Json outputs = Json::array();
  for (const auto& output : frame.outputs) outputs.push_back(output.string());
  Json json = {{"number", frame.number}, {"outputs", outputs}, {"skipped", record == nullptr}};
  json["time"] = frame.data.time;
  if (frame.data.in_file) json["time_step"] = *frame.data.in_file;
  for (const auto& file : frame.data.files) json["meshes"].push_back(file.string());
  if (record == nullptr) return json;
  const FrameStatistics& statistics = record->statistics;
  json["view"] = analysis::view_json(record->camera, frame.size);
  json["frame_ms"] = record->frame_ms;
  json["counters"] = analysis::counters_json(statistics, options.is_grid());
  json["instruction_set"] = statistics.instruction_set;
  if (options.is_grid()) {
    json["balance"] = analysis::balance_json(options.settings.ranks.balance, statistics);
  } else {
    json["arithmetic"] = statistics.on_lattice ? "lattice" : "double";
    json["integrator"] = statistics.integrator;
    json["backend"] = statistics.composited_on.empty() ? "cpu" : statistics.composited_on;
    json["overlapping"] = statistics.overlapping;
  }
  if (record->verification) json["verify"] = analysis::verification_json(*record->verification);
  return json;
}

std::string samples_line(const Description& grid) {
  const GridIndex n = grid.geometry.samples();
  std::string line = fmt::format("{}x{}x{} {} samples", n[0], n[1], n[2], name_of(grid.type));
  if (grid.blanks > 0) line += fmt::format(", {} blank", grid.blanks);
  return line;
}

std::string cells_line(const MeshCounts& counts) {
  std::uint64_t kept = counts.cells_read;
  std::string fates;
  for (const MeshCounter& counter : mesh_counters) {
    const std::uint64_t count = counts.*counter.member;
    if (counter.fate == MeshCounter::Fate::other || count == 0) continue;
    if (counter.fate == MeshCounter::Fate::dropped) kept -= count;
    fates += fmt::format(", {} {}", count, counter.meaning);
  }
  return fmt::format("{} of {} cells kept as {} tets{}", kept, counts.cells_read, counts.tets_made, fates);
}

std::string higher_order_note(double error, double accuracy) {
  std::string note =
      fmt::format("higher-order cells are replaced by tets, which changes pixels of the first image by {}",
                  error < 1 ? fmt::format("about {:.2g}", error) : "any amount");
  if (error > accuracy)
    note += fmt::format(", more than --accuracy {:.2g}; --higher-order-tets allows more tets", accuracy);
  return note;
}

std::string view_line(const Camera& camera) {
  // Points that are close to each other and far from the origin need more digits to be distinguished.
  const glm::dvec3 eye = glm::abs(camera.position), centre = glm::abs(camera.focal_point);
  const int digits = digits_for(std::max({eye.x, eye.y, eye.z, centre.x, centre.y, centre.z}),
                                glm::distance(camera.position, camera.focal_point));
  const auto point = [&](const glm::dvec3& p) {
    return fmt::format("({:.{}g} {:.{}g} {:.{}g})", p.x, digits, p.y, digits, p.z, digits);
  };
  const bool perspective = camera.projection == ProjectionKind::perspective;
  return fmt::format("{} from {} to {}, {} {:.6g}", perspective ? "perspective" : "orthographic",
                     point(camera.position), point(camera.focal_point), perspective ? "angle" : "scale",
                     perspective ? camera.view_angle : camera.parallel_scale);
}

std::string transfer_function_line(const LoadedTransferFunction& loaded) {
  std::string line = fmt::format("transfer function {}", loaded.name);
  if (loaded.unit_distance)
    line += fmt::format(", unit distance {:.6g} ({})", *loaded.unit_distance, loaded.unit_distance_source);
  return line;
}

std::string frame_line(const RenderOptions& options, const std::vector<FilmFrame>& frames, const FilmFrame& frame,
                       const FrameRecord& record) {
  std::string line = fmt::format("frame {} of {}: ", frame.number + 1, frames.size());
  if (is_series(options.plan)) {
    line += frame.data.files.front().filename().string();
    if (frame.data.files.size() > 1) line += fmt::format(" and {} more", frame.data.files.size() - 1);
    if (frame.data.in_file) line += fmt::format(", time step {}", *frame.data.in_file);
    line += ", ";
  }
  const std::string work = options.is_grid() ? fmt::format("{} voxels visited", record.statistics.grid.voxels_visited)
                                             : fmt::format("{} tets projected", record.statistics.mesh.tets_projected);
  return line + fmt::format("{}, {}{}", work, time_words(record.frame_ms.front()), balance_words(options, record));
}

/// Returns what a frame computed in double precision, if that took about a tenth of its time or more.
std::string double_precision_words(const FrameStatistics& statistics, bool is_grid) {
  const InDoublePrecision part = in_double_precision(statistics, is_grid);
  // A segment or pixel takes about five times as long as in float lanes.
  if (part.parts == 0 || 50 * part.parts < part.all) return "";
  const double percent = 100 * static_cast<double>(part.parts) / static_cast<double>(part.all);
  return fmt::format(", {:.3g} % of the {} in double precision", percent, is_grid ? "pixels" : "ray segments");
}

std::string run_line(const RenderOptions& options, const Description& data, const LoadedTransferFunction& loaded,
                     const std::vector<FilmFrame>& frames, const FilmFrame& first, const FrameRecord& record) {
  const FrameStatistics& statistics = record.statistics;
  std::string line =
      fmt::format("{}: {}; field {} ({}) {}; {}; view {}, {}x{}",
                  options.is_grid() ? first.data.files.front().string() : options.input().string(),
                  options.is_grid() ? samples_line(data) : cells_line(data.counts), data.field_name,
                  word(data.association), range_words(data.range[0], data.range[1]), transfer_function_line(loaded),
                  view_line(record.camera), first.size.width, first.size.height);
  if (frames.size() > 1) line += fmt::format(" (frame {} of {})", first.number + 1, frames.size());
  if (options.is_grid()) {
    const GridCounters& s = statistics.grid;
    line += fmt::format("; {} of {} bricks invisible, {} loaded; {} voxels visited; {}, {}{}, {}{}", s.bricks_invisible,
                        s.bricks_total, s.bricks_loaded, s.voxels_visited, method_words(options.settings),
                        statistics.instruction_set, double_precision_words(statistics, true),
                        time_words(record.frame_ms.front()), balance_words(options, record));
  } else {
    const FrameCounters& s = statistics.mesh;
    line += fmt::format("; {} tets projected, {} invisible, {} outside the view; {}, {}, {}{}, {}", s.tets_projected,
                        s.tets_invisible, s.tets_outside_view, word(options.settings.mesh.rasterizer),
                        method_line(options.settings.integrator) + (options.settings.mesh.shading ? ", shaded" : ""),
                        statistics.instruction_set, double_precision_words(statistics, false),
                        time_words(record.frame_ms.front()));
    if (!options.settings.mesh.device.backends.empty())
      line += fmt::format("; composited by {}", statistics.composited_on);
    if (statistics.overlapping) line += "; ray segments exchanged, because cells of several ranks overlap";
  }
  if (const std::size_t steps = frames.back().step + 1; is_series(options.plan))
    line += first.camera ? fmt::format("; {} time steps", steps)
                         : fmt::format("; the view of the first of {} time steps, {}, is used for all", steps,
                                       frames.front().data.files.front().string());
  return line;
}

std::string verification_line(const Verification& v, int frame_number) {
  const bool met = v.met || (!v.layers_met && v.over_bound == v.excused);  // whether the image alone, without its
                                                                           // layers, meets the bound
  const auto verdict =
      v.bound ? fmt::format("bound {:.3g} {}", *v.bound, met ? "met" : "NOT met") : std::string("no bound promised");
  std::string line =
      fmt::format("verify frame {}: {} pixels, max {:.3g} rms {:.3g}, worst at ({}, {}), {} excused; {}", frame_number,
                  v.pixels_checked, v.max_error, v.rms_error, v.worst_x, v.worst_y, v.excused, verdict);
  line += fmt::format("; worst: {}; chosen: {} random", v.worst_reason, v.tallies.front().pixels);
  for (const Verification::Tally& tally : std::span(v.tallies).subspan(1))
    line += fmt::format(", {} {}", tally.pixels, tally.reason);
  if (v.layers.empty()) return line;
  const auto worst = std::ranges::max_element(v.layers, {}, &Verification::Tally::max_error);
  std::size_t excused = 0;
  for (const Verification::Tally& layer : v.layers) excused += layer.excused;
  line += fmt::format("; {} layers: max {:.3g} in {}, {} excused; bound {:.3g} {}", v.layers.size(), worst->max_error,
                      worst->reason, excused, v.layer_bound, v.layers_met ? "met" : "NOT met");
  return line;
}

}  // namespace tessera::apps
