#include "apps/volume_input.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apps/output_check.hpp"
#include "apps/report.hpp"
#include "apps/session_options.hpp"
#include "apps/setting_words.hpp"
#include "frame/dataset.hpp"
#include "frame/mesh_input.hpp"
#include "io/volume_writer.hpp"
#include "scene/error.hpp"
#include "tessera/write.hpp"

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

void volume_info(const std::filesystem::path& input, const io::VolumeOptions& options, bool as_json) {
  const Dataset data = Dataset::open(input, read_options(options));
  const Description volume(data);
  const auto loaded = transfer_function_of(data, RenderOptions{});
  const scene::ImageSize size;
  const scene::Camera view = data.default_camera(size);
  if (as_json) {
    auto json = data_json(input, volume);
    json["renders"] = {{"transfer_function", transfer_function_json(loaded)}, {"view", view_json(view, size)}};
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
    return;
  }
  fmt::print("file      {}\n", input.string());
  fmt::print("format    {}\n", volume.format);
  fmt::print("lattice   {}\n", lattice_line(volume.geometry));
  fmt::print("samples   {}\n", samples_line(volume));
  fmt::print("bounds    {} to {}, diagonal {:.6g}\n", triple(volume.box.low), triple(volume.box.high),
             frame::diagonal(volume.box));
  std::size_t widest = 0;
  for (const auto& field : volume.fields) widest = std::max(widest, field.name.size());
  const char* title = "fields";
  for (const auto& field : volume.fields) {
    fmt::print("{:<9} {:<{}}  {:<5}  {:<7} x {}  {:.6g} to {:.6g}{}\n", title, field.name, widest,
               element(field.association), field.type, field.components, field.low, field.high,
               field.nan_count > 0 ? fmt::format(", {} NaN", field.nan_count) : "");
    title = "";
  }
  fmt::print("renders   field {}, {:.6g} to {:.6g}; {}; view {}\n", volume.field_name, volume.range[0], volume.range[1],
             transfer_function_line(loaded), view_line(view));
  for (const auto& note : volume.notes) fmt::print("note      {}\n", note);
}

void convert_volume(const std::filesystem::path& input, const std::filesystem::path& output,
                    const io::VolumeOptions& options, int block, bool quiet) {
  if (!io::is_volume_output(output))
    throw scene::bad_input(
        fmt::format("{}: '{}' is no volume format to write; choose .vti, .vtr, .nrrd, .raw or .bricks", output.string(),
                    output.extension().string()));
  check_output_file(output, input);
  const Dataset data = Dataset::open(input, read_options(options));
  write_grid(data, output, block);
  if (quiet) return;
  const scene::GridGeometry& g = data.grid_geometry();
  const bool raw = output.extension() == ".raw";
  fmt::print(
      stderr, "{}: {}; field {} written to {}{}\n", input.string(), samples_line(Description(data)), data.field_name(),
      output.string(),
      raw ? fmt::format("; read it with --dims {}x{}x{} --type {} --spacing {},{},{} --origin {},{},{}", g.points[0],
                        g.points[1], g.points[2], scene::name_of(io::written_type(data.state().samples->grid())),
                        g.spacing.x, g.spacing.y, g.spacing.z, g.origin.x, g.origin.y, g.origin.z)
          : "");
}

}  // namespace tessera::apps
