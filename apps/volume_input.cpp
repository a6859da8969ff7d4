#include "apps/volume_input.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apps/mesh_input.hpp"
#include "apps/output_check.hpp"
#include "apps/report.hpp"
#include "apps/setting_words.hpp"
#include "io/volume_writer.hpp"
#include "scene/error.hpp"

namespace tessera::apps {
namespace {

using Json = nlohmann::ordered_json;

const char* element(scene::Association association) {
  return association == scene::Association::point ? "point" : "cell";
}

std::string triple(const glm::dvec3& v) { return fmt::format("({:.9g} {:.9g} {:.9g})", v.x, v.y, v.z); }

std::string lattice_line(const scene::GridGeometry& g) {
  std::string line = fmt::format("{}x{}x{} points, origin {}", g.points[0], g.points[1], g.points[2], triple(g.origin));
  if (g.rectilinear())
    line += ", rectilinear";
  else
    line += fmt::format(", spacing {}", triple(g.spacing));
  if (g.direction != glm::dmat3(1.0))
    line += fmt::format(", axes {} {} {}", triple(g.direction[0]), triple(g.direction[1]), triple(g.direction[2]));
  return line;
}

}  // namespace

scene::MeshFacts facts_of(const io::VolumeFile& volume) {
  const scene::GridGeometry& g = volume.source->geometry();
  return {scene::bounds(g), {volume.range.low, volume.range.high}, scene::mean_thickness(g), 0, g.association};
}

std::string samples_line(const io::VolumeFile& volume) {
  const scene::Grid& grid = volume.source->grid();
  const scene::GridIndex n = grid.geometry.samples();
  std::string line = fmt::format("{}x{}x{} {} samples", n[0], n[1], n[2], scene::name_of(grid.type));
  if (volume.range.blanks > 0) line += fmt::format(", {} blank", volume.range.blanks);
  return line;
}

Json volume_json(const std::filesystem::path& input, const io::VolumeFile& volume) {
  const scene::Grid& grid = volume.source->grid();
  const scene::GridGeometry& g = grid.geometry;
  const auto vector = [](const glm::dvec3& v) { return Json{v.x, v.y, v.z}; };
  const scene::Box box = scene::bounds(g);
  Json fields = Json::array();
  for (const auto& field : volume.fields)
    fields.push_back({{"name", field.name},
                      {"association", element(field.association)},
                      {"components", field.components},
                      {"type", field.type},
                      {"range", {field.low, field.high}},
                      {"nan", field.nan_count}});
  return {{"file", input.string()},
          {"format", volume.format},
          {"points", g.points},
          {"rectilinear", g.rectilinear()},
          {"origin", vector(g.origin)},
          {"spacing", vector(g.spacing)},
          {"direction", {vector(g.direction[0]), vector(g.direction[1]), vector(g.direction[2])}},
          {"bounds", {vector(box.low), vector(box.high)}},
          {"type", scene::name_of(grid.type)},
          {"scale", grid.scale},
          {"shift", grid.shift},
          {"field",
           {{"name", grid.field_name},
            {"association", element(g.association)},
            {"range", {volume.range.low, volume.range.high}},
            {"blank", volume.range.blanks}}},
          {"fields", fields},
          {"notes", with_options(volume.notes)}};
}

void volume_info(const std::filesystem::path& input, const io::VolumeOptions& options, bool as_json) {
  const io::VolumeFile volume = io::open_volume(input, options);
  const scene::MeshFacts facts = facts_of(volume);
  RenderOptions defaults;
  defaults.is_volume = true;
  const auto loaded = transfer_function_of(facts, defaults);
  const scene::ImageSize size;
  const scene::Camera view = scene::frame_box(facts.box, size);
  if (as_json) {
    auto json = volume_json(input, volume);
    json["renders"] = {{"transfer_function", transfer_function_json(loaded)}, {"view", view_json(view, size)}};
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
    return;
  }
  fmt::print("file      {}\n", input.string());
  fmt::print("format    {}\n", volume.format);
  fmt::print("lattice   {}\n", lattice_line(volume.source->geometry()));
  fmt::print("samples   {}\n", samples_line(volume));
  fmt::print("bounds    {} to {}, diagonal {:.6g}\n", triple(facts.box.low), triple(facts.box.high),
             diagonal(facts.box));
  std::size_t widest = 0;
  for (const auto& field : volume.fields) widest = std::max(widest, field.name.size());
  const char* title = "fields";
  for (const auto& field : volume.fields) {
    fmt::print("{:<9} {:<{}}  {:<5}  {:<7} x {}  {:.6g} to {:.6g}{}\n", title, field.name, widest,
               element(field.association), field.type, field.components, field.low, field.high,
               field.nan_count > 0 ? fmt::format(", {} NaN", field.nan_count) : "");
    title = "";
  }
  fmt::print("renders   field {}, {:.6g} to {:.6g}; {}; view {}\n", volume.source->grid().field_name, volume.range.low,
             volume.range.high, transfer_function_line(loaded), view_line(view));
  for (const auto& note : with_options(volume.notes)) fmt::print("note      {}\n", note);
}

void convert_volume(const std::filesystem::path& input, const std::filesystem::path& output,
                    const io::VolumeOptions& options, int block, bool quiet) {
  if (!io::is_volume_output(output))
    throw scene::bad_input(
        fmt::format("{}: '{}' is no volume format to write; choose .vti, .vtr, .nrrd, .raw or .bricks", output.string(),
                    output.extension().string()));
  check_output_file(output, input);
  const io::VolumeFile volume = io::open_volume(input, options);
  io::write_volume(*volume.source, output, block);
  if (quiet) return;
  const scene::GridGeometry& g = volume.source->geometry();
  const bool raw = output.extension() == ".raw";
  fmt::print(
      stderr, "{}: {}; field {} written to {}{}\n", input.string(), samples_line(volume),
      volume.source->grid().field_name, output.string(),
      raw ? fmt::format("; read it with --dims {}x{}x{} --type {} --spacing {},{},{} --origin {},{},{}", g.points[0],
                        g.points[1], g.points[2], scene::name_of(io::written_type(volume.source->grid())), g.spacing.x,
                        g.spacing.y, g.spacing.z, g.origin.x, g.origin.y, g.origin.z)
          : "");
}

}  // namespace tessera::apps
