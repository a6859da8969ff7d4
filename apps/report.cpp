#include "apps/report.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "io/camera_file.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::apps {
namespace {

using Json = nlohmann::ordered_json;

const char* word(scene::Association association) { return association == scene::Association::point ? "point" : "cell"; }

const char* word(frame::Rasterizer rasterizer) {
  return rasterizer == frame::Rasterizer::planes ? "planes" : "scanline";
}

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

}  // namespace

Json mesh_json(const std::filesystem::path& input, const MeshSummary& mesh) {
  const auto& counts = mesh.counts;
  const auto& box = mesh.facts.box;
  Json fields = Json::array();
  for (const auto& field : mesh.fields)
    fields.push_back({{"name", field.name},
                      {"association", word(field.association)},
                      {"components", field.components},
                      {"type", field.type},
                      {"range", {field.low, field.high}},
                      {"nan", field.nan_count}});
  return {
      {"file", input.string()},
      {"format", mesh.format},
      {"cells",
       {{"read", counts.cells_read},
        {"ghost", counts.cells_ghost},
        {"hidden", counts.cells_hidden},
        {"nan", counts.cells_nan},
        {"not_volumetric", counts.cells_not_volumetric},
        {"zero_volume", counts.cells_zero_volume},
        {"tangled", counts.cells_tangled},
        {"quadratic", counts.cells_quadratic}}},
      {"tets", counts.tets_made},
      {"tets_collapsed", counts.tets_collapsed},
      {"points", {{"read", counts.points_read}, {"unused", counts.points_unused}}},
      {"bounds", {vector_json(box.low), vector_json(box.high)}},
      {"field",
       {{"name", mesh.field_name}, {"association", word(mesh.facts.association)}, {"range", mesh.facts.scalar_range}}},
      {"fields", fields},
      {"notes", mesh.notes}};
}

Json transfer_function_json(const colormaps::LoadedTransferFunction& loaded) {
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

Json method_json(const RenderOptions& options) {
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

Json frame_json(const Frame& frame, const FrameRecord* record) {
  Json outputs = Json::array();
  for (const auto& output : frame.outputs) outputs.push_back(output.string());
  Json json = {{"number", frame.number}, {"outputs", outputs}, {"skipped", record == nullptr}};
  json["time"] = frame.mesh.time;
  for (const auto& file : frame.mesh.files) json["meshes"].push_back(file.string());
  if (record == nullptr) return json;
  const auto& statistics = record->statistics;
  json["view"] = view_json(record->camera, frame.size);
  json["frame_ms"] = record->frame_ms;
  for (const scene::FrameCounter& counter : scene::frame_counters)
    if (const std::uint64_t count = statistics.*counter.member; count > 0 || !counter.if_any)
      json["counters"][std::string(counter.name)] = count;
  json["instruction_set"] = statistics.instruction_set;
  json["arithmetic"] = statistics.on_lattice ? "lattice" : "double";
  json["integrator"] = statistics.integrator;
  json["backend"] = statistics.composited_on.empty() ? "cpu" : statistics.composited_on;
  if (record->verification) json["verify"] = verification_json(*record->verification);
  return json;
}

std::string cells_line(const io::MeshCounts& counts) {
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

std::string transfer_function_line(const colormaps::LoadedTransferFunction& loaded) {
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
  const double ms = record.frame_ms.front();
  return line + fmt::format("{} tets projected, {} ms", record.statistics.tets_projected,
                            ms < 100 ? fmt::format("{:.3g}", ms) : fmt::format("{:.0f}", ms));
}

std::string run_line(const RenderOptions& options, const MeshSummary& mesh,
                     const colormaps::LoadedTransferFunction& loaded, const std::vector<Frame>& frames,
                     const Frame& first, const FrameRecord& record) {
  const auto& statistics = record.statistics;
  std::string line = fmt::format("{}: {}; field {} ({}) {:.6g} to {:.6g}; {}; view {}, {}x{}", options.input.string(),
                                 cells_line(mesh.counts), mesh.field_name, word(mesh.facts.association),
                                 mesh.facts.scalar_range[0], mesh.facts.scalar_range[1], transfer_function_line(loaded),
                                 view_line(record.camera), first.size.width, first.size.height);
  if (frames.size() > 1) line += fmt::format(" (frame {} of {})", first.number + 1, frames.size());
  line += fmt::format("; {} tets projected, {} invisible, {} outside the view; {}, {}, {}, {:.3g} ms",
                      statistics.tets_projected, statistics.tets_invisible, statistics.tets_outside_view,
                      word(options.settings.rasterizer), method_line(options.settings.integrator),
                      statistics.instruction_set, record.frame_ms.front());
  if (!options.compositing_on.backends.empty()) line += fmt::format("; composited by {}", statistics.composited_on);
  if (const std::size_t steps = frames.back().step + 1; is_series(options))
    line += fmt::format("; transfer function{} of the first of {} time steps, {}, for all",
                        first.camera ? "" : " and view", steps, frames.front().mesh.files.front().string());
  for (const auto& note : mesh.notes) line += fmt::format("; {}", note);
  return line;
}

}  // namespace tessera::apps
