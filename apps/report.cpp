#include "apps/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string_view>
#include <utility>

#include "apps/setting_words.hpp"
#include "io/camera_file.hpp"
#include "tessera/settings.hpp"

namespace tessera::apps {
namespace {

using Json = nlohmann::ordered_json;

const char* word(scene::Association association) { return association == scene::Association::point ? "point" : "cell"; }

const char* word(Rasterizer rasterizer) { return rasterizer == Rasterizer::planes ? "planes" : "scanline"; }

std::string method_line(const scene::Integrator& integrator) {
  switch (integrator.kind) {
    case scene::IntegratorKind::exact:
      return "exact";
    case scene::IntegratorKind::sampled:
      return fmt::format("sampled:{}", integrator.samples);
    case scene::IntegratorKind::preintegrated:
      return fmt::format("preintegrated:{}", integrator.table_size);
    case scene::IntegratorKind::partial:
      return "partial";
    case scene::IntegratorKind::automatic:
      break;
  }
  return fmt::format("auto to {:g}", integrator.accuracy);
}

Json vector_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

std::string ms_words(double ms) { return ms < 100 ? fmt::format("{:.3g}", ms) : fmt::format("{:.0f}", ms); }

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

bool takes_steps(volume::Method method) {
  return method == volume::Method::sampled || method == volume::Method::preintegrated;
}

std::string method_words(const volume::RenderSettings& settings) {
  std::string words = method_word(settings.method);
  if (settings.method == volume::Method::automatic) words += fmt::format(" to {:g}", settings.accuracy);
  if (takes_steps(settings.method)) words += fmt::format(" every {:g} voxels", settings.step);
  if (settings.shading) words += ", shaded";
  return words;
}

/// How the work was shared, if it was.
std::string balance_words(const RenderOptions& options, const FrameRecord& record) {
  const auto& by_rank = record.statistics.samples;
  if (by_rank.size() < 2) return {};
  const std::vector<double> samples(by_rank.begin(), by_rank.end());
  return fmt::format(", {} processes by {}: samples uneven by {:.1f} %", samples.size(),
                     balance_word(options.balance.balance), 100 * deviation(samples));
}

Json balance_json(const RenderOptions& options, const FrameStatistics& statistics) {
  Json processes = Json::array();
  for (std::size_t rank = 0; rank < statistics.samples.size(); ++rank) {
    const PixelRect& r = statistics.rectangles[rank];
    processes.push_back({{"rectangle", {r.x0, r.y0, r.x1, r.y1}},
                         {"samples", statistics.samples[rank]},
                         {"cpu_ms", 1e3 * statistics.cpu_seconds[rank]}});
  }
  return {{"method", balance_word(options.balance.balance)},
          {"samples_deviation", deviation({statistics.samples.begin(), statistics.samples.end()})},
          {"cpu_deviation", deviation(statistics.cpu_seconds)},
          {"processes", processes}};
}

}  // namespace

Description::Description(const Dataset& data)
    : is_mesh(data.is_mesh()),
      format(data.format()),
      field_name(data.field_name()),
      association(data.association()),
      box(data.bounds()),
      range(data.range()),
      fields(data.fields().begin(), data.fields().end()),
      notes(with_options(std::vector<std::string>(data.notes().begin(), data.notes().end()))),
      counts(data.mesh_counts()),
      scale(data.scale()),
      shift(data.shift()),
      blanks(data.blank_samples()) {
  if (is_mesh) return;
  geometry = data.grid_geometry();
  type = data.sample_type();
}

Json data_json(const std::filesystem::path& input, const Description& data) {
  Json json = {{"file", input.string()}, {"format", data.format}};
  if (data.is_mesh) {
    const MeshCounts& counts = data.counts;
    json["cells"] = {{"read", counts.cells_read},
                     {"ghost", counts.cells_ghost},
                     {"hidden", counts.cells_hidden},
                     {"nan", counts.cells_nan},
                     {"not_volumetric", counts.cells_not_volumetric},
                     {"zero_volume", counts.cells_zero_volume},
                     {"tangled", counts.cells_tangled},
                     {"quadratic", counts.cells_quadratic}};
    json["tets"] = counts.tets_made;
    json["tets_collapsed"] = counts.tets_collapsed;
    json["points"] = {{"read", counts.points_read}, {"unused", counts.points_unused}};
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
  json["notes"] = data.notes;
  return json;
}

Json transfer_function_json(const LoadedTransferFunction& loaded) {
  Json knots = Json::array();
  for (const auto& knot : loaded.function.knots())
    knots.push_back({knot.value, knot.color.x, knot.color.y, knot.color.z, knot.extinction});
  Json json = {{"name", loaded.name}};
  if (loaded.unit_distance)
    json["unit_distance"] = {{"value", *loaded.unit_distance}, {"source", loaded.unit_distance_source}};
  json["knots"] = knots;
  return json;
}

Json view_json(const scene::Camera& camera, scene::ImageSize size) {
  return Json::parse(io::camera_json({camera, size}));
}

namespace {

Json mesh_method_json(const RenderOptions& options) {
  const auto& settings = options.settings;
  Json json = {{"integrator", method_line(settings.integrator)}};
  if (settings.integrator.kind == scene::IntegratorKind::automatic) json["accuracy"] = settings.integrator.accuracy;
  json["emission"] = settings.emission == scene::Emission::absorption ? "absorption" : "independent";
  if (options.deep) json["deep_accuracy"] = settings.deep_accuracy;
  json["rasterizer"] = word(settings.rasterizer);
  const auto& on = options.compositing_on;
  const bool fragment = on.gl.method == compositor::GlMethod::fragment;
  json["compositor"] = on.backends.empty() ? "cpu" : fragment ? "gl-fragment" : "gl-compute";
  if (!on.backends.empty() && fragment) json["framebuffer"] = on.gl.half ? "half" : "float";
  if (!options.without.empty()) json["without"] = options.without;
  json["blend"] = options.display_blend ? "display" : "linear";
  json["threads"] = settings.threads;  // 0: all cores
  json["tile_size"] = settings.tile_size;
  json["memory_bytes"] = settings.memory_bytes;
  return json;
}

Json grid_method_json(const RenderOptions& options, int ranks) {
  const volume::RenderSettings& s = options.volume_settings;
  Json json = {{"integrator", method_word(s.method)}};
  if (s.method == volume::Method::automatic) json["accuracy"] = s.accuracy;
  if (takes_steps(s.method)) json["step"] = s.step;
  json["emission"] = s.emission == scene::Emission::absorption ? "absorption" : "independent";
  json["shade"] = s.shading.has_value();
  if (s.shading)
    json["light"] = {{"frame", s.shading->camera_light ? "camera" : "world"},
                     {"direction", {s.shading->to_light.x, s.shading->to_light.y, s.shading->to_light.z}}};
  json["backend"] = "cpu";
  if (!options.without.empty()) json["without"] = options.without;
  json["blend"] = options.display_blend ? "display" : "linear";
  json["threads"] = s.threads;
  json["brick_size"] = s.brick_size;
  json["cache"] = s.cache == volume::CachePolicy::lru ? "lru" : "proximity";
  json["preload"] = s.preload_limit;
  json["memory_bytes"] = s.memory_bytes;
  json["ranks"] = ranks;
  json["balance"] = {{"method", balance_word(options.balance.balance)},
                     {"resolution", options.balance.resolution},
                     {"weights", options.balance.weights}};
  return json;
}

}  // namespace

Json method_json(const RenderOptions& options, int ranks) {
  return options.is_volume ? grid_method_json(options, ranks) : mesh_method_json(options);
}

Json job_json(const RenderOptions& options, int ranks, const frame::Roles& roles, const Settings& settings) {
  constexpr std::array partitions = {"file", "curve", "random"};
  return {{"ranks", ranks},
          {"projectors", roles.projectors},
          {"compositors", roles.compositors},
          {"exchange", exchange_word(options.exchange)},
          {"partition", partitions[static_cast<std::size_t>(options.partition.kind)]},
          {"frames_in_flight", settings.ranks.frames_in_flight},
          {"seed", options.tile_seed}};
}

const char* exchange_word(Exchange exchange) { return exchange == Exchange::runs ? "runs" : "segments"; }

double deviation(const std::vector<double>& work) {
  const double sum = std::accumulate(work.begin(), work.end(), 0.0);
  if (!(sum > 0)) return 0;
  const auto [least, most] = std::minmax_element(work.begin(), work.end());
  return (*most - *least) * static_cast<double>(work.size()) / sum;
}

const char* balance_word(Balance balance) {
  constexpr std::array words = {"accurate", "backface", "splatting", "previous", "even"};
  return words[static_cast<std::size_t>(balance)];
}

const char* method_word(volume::Method method) {
  constexpr std::array words = {"auto", "exact", "sampled", "preintegrated"};
  return words[static_cast<std::size_t>(method)];
}

namespace {

Json counters_json(const FrameStatistics& statistics) {
  Json json;
  for (const FrameCounter& counter : frame_counters)
    if (const std::uint64_t count = statistics.mesh.*counter.member; count > 0 || !counter.if_any)
      json[std::string(counter.name)] = count;
  return json;
}

Json grid_counters_json(const FrameStatistics& statistics) {
  const GridCounters& s = statistics.grid;
  Json json = {{"rays", s.rays},
               {"voxels_visited", s.voxels_visited},
               {"samples", s.samples},
               {"pixels_in_double_precision", s.pixels_again},
               {"bricks_total", s.bricks_total},
               {"bricks_invisible", s.bricks_invisible},
               {"brick_hits", s.brick_hits},
               {"bricks_loaded", s.bricks_loaded},
               {"bricks_evicted", s.bricks_evicted},
               {"bytes_loaded", s.bytes_loaded},
               {"bytes_resident", s.bytes_resident},
               {"peak_bytes", s.peak_bytes},
               {"blank_samples", s.blank_samples}};
  if (statistics.mesh.deep_samples > 0) json["deep_samples"] = statistics.mesh.deep_samples;
  return json;
}

}  // namespace

Json frame_json(const RenderOptions& options, const Frame& frame, const FrameRecord* record) {
  Json outputs = Json::array();
  for (const auto& output : frame.outputs) outputs.push_back(output.string());
  Json json = {{"number", frame.number}, {"outputs", outputs}, {"skipped", record == nullptr}};
  json["time"] = frame.mesh.time;
  for (const auto& file : frame.mesh.files) json["meshes"].push_back(file.string());
  if (record == nullptr) return json;
  const FrameStatistics& statistics = record->statistics;
  json["view"] = view_json(record->camera, frame.size);
  json["frame_ms"] = record->frame_ms;
  json["counters"] = options.is_volume ? grid_counters_json(statistics) : counters_json(statistics);
  json["instruction_set"] = statistics.instruction_set;
  if (options.is_volume) {
    json["balance"] = balance_json(options, statistics);
  } else {
    json["arithmetic"] = statistics.on_lattice ? "lattice" : "double";
    json["integrator"] = statistics.integrator;
    json["backend"] = statistics.composited_on.empty() ? "cpu" : statistics.composited_on;
  }
  if (record->verification) json["verify"] = verification_json(*record->verification);
  return json;
}

std::string samples_line(const Description& grid) {
  const GridIndex n = grid.geometry.samples();
  std::string line = fmt::format("{}x{}x{} {} samples", n[0], n[1], n[2], name_of(grid.type));
  if (grid.blanks > 0) line += fmt::format(", {} blank", grid.blanks);
  return line;
}

std::string cells_line(const MeshCounts& counts) {
  const std::uint64_t dropped =
      counts.cells_ghost + counts.cells_hidden + counts.cells_nan + counts.cells_not_volumetric;
  std::string line =
      fmt::format("{} of {} cells kept as {} tets", counts.cells_read - dropped, counts.cells_read, counts.tets_made);
  const std::pair<std::uint64_t, std::string_view> reasons[] = {
      {counts.cells_ghost, "ghost dropped"},
      {counts.cells_hidden, "hidden dropped"},
      {counts.cells_nan, "NaN dropped"},
      {counts.cells_not_volumetric, "without volume by type skipped"},
      {counts.cells_zero_volume, "of zero volume kept"},
      {counts.cells_tangled, "tangled kept"},
      {counts.cells_quadratic, "quadratic by their corners"}};
  for (const auto& [count, reason] : reasons)
    if (count > 0) line += fmt::format(", {} {}", count, reason);
  return line;
}

std::string view_line(const scene::Camera& camera) {
  const auto point = [](const glm::dvec3& p) { return fmt::format("({:.6g} {:.6g} {:.6g})", p.x, p.y, p.z); };
  const bool perspective = camera.projection == scene::ProjectionKind::perspective;
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

std::string frame_line(const RenderOptions& options, const std::vector<Frame>& frames, const Frame& frame,
                       const FrameRecord& record) {
  std::string line = fmt::format("frame {} of {}: ", frame.number + 1, frames.size());
  if (is_series(options)) {
    line += frame.mesh.files.front().filename().string();
    if (frame.mesh.files.size() > 1) line += fmt::format(" and {} more", frame.mesh.files.size() - 1);
    line += ", ";
  }
  const std::string work = options.is_volume ? fmt::format("{} voxels visited", record.statistics.grid.voxels_visited)
                                             : fmt::format("{} tets projected", record.statistics.mesh.tets_projected);
  return line + fmt::format("{}, {} ms{}", work, ms_words(record.frame_ms.front()), balance_words(options, record));
}

std::string run_line(const RenderOptions& options, const Description& data, const LoadedTransferFunction& loaded,
                     const std::vector<Frame>& frames, const Frame& first, const FrameRecord& record) {
  const FrameStatistics& statistics = record.statistics;
  std::string line = fmt::format("{}: {}; field {} ({}) {:.6g} to {:.6g}; {}; view {}, {}x{}",
                                 options.is_volume ? first.mesh.files.front().string() : options.input.string(),
                                 options.is_volume ? samples_line(data) : cells_line(data.counts), data.field_name,
                                 word(data.association), data.range[0], data.range[1], transfer_function_line(loaded),
                                 view_line(record.camera), first.size.width, first.size.height);
  if (frames.size() > 1) line += fmt::format(" (frame {} of {})", first.number + 1, frames.size());
  if (options.is_volume) {
    const GridCounters& s = statistics.grid;
    line += fmt::format("; {} of {} bricks invisible, {} loaded; {} voxels visited; {}, {}, {:.3g} ms{}",
                        s.bricks_invisible, s.bricks_total, s.bricks_loaded, s.voxels_visited,
                        method_words(options.volume_settings), statistics.instruction_set, record.frame_ms.front(),
                        balance_words(options, record));
  } else {
    const FrameCounters& s = statistics.mesh;
    line += fmt::format("; {} tets projected, {} invisible, {} outside the view; {}, {}, {}, {:.3g} ms",
                        s.tets_projected, s.tets_invisible, s.tets_outside_view, word(options.settings.rasterizer),
                        method_line(options.settings.integrator), statistics.instruction_set, record.frame_ms.front());
    if (!options.compositing_on.backends.empty()) line += fmt::format("; composited by {}", statistics.composited_on);
  }
  if (const std::size_t steps = frames.back().step + 1; is_series(options))
    line += fmt::format("; transfer function{} of the first of {} time steps, {}, for all",
                        first.camera ? "" : " and view", steps, frames.front().mesh.files.front().string());
  for (const auto& note : data.notes) line += fmt::format("; {}", note);
  return line;
}

}  // namespace tessera::apps
