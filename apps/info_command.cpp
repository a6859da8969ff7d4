#include "apps/info_command.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apps/mesh_input.hpp"
#include "apps/report.hpp"

namespace tessera::apps {
namespace {

void print_text(const std::filesystem::path& input, const MeshSummary& file, const io::LoadedTransferFunction& loaded) {
  const auto& counts = file.counts;
  const auto& box = file.facts.box;
  fmt::print("file      {}\n", input.string());
  fmt::print("format    {}\n", file.format);
  fmt::print("cells     {}\n", cells_line(counts));
  fmt::print("points    {}, {} of them in no cell kept\n", counts.points_read, counts.points_unused);
  fmt::print("bounds    ({:.9g} {:.9g} {:.9g}) to ({:.9g} {:.9g} {:.9g}), diagonal {:.6g}\n", box.low.x, box.low.y,
             box.low.z, box.high.x, box.high.y, box.high.z, diagonal(box));
  std::size_t widest = 0;
  for (const auto& field : file.fields) widest = std::max(widest, field.name.size());
  const char* title = "fields";
  for (const auto& field : file.fields) {
    fmt::print("{:<9} {:<{}}  {:<5}  {:<7} x {}  {:.6g} to {:.6g}{}\n", title, field.name, widest,
               field.association == scene::Association::point ? "point" : "cell", field.type, field.components,
               field.low, field.high, field.nan_count > 0 ? fmt::format(", {} NaN", field.nan_count) : "");
    title = "";
  }
  const auto& range = file.facts.scalar_range;
  const auto view = scene::frame_box(box, scene::ImageSize{});
  fmt::print("renders   field {}, {:.6g} to {:.6g}; {}; view {}\n", file.field_name, range[0], range[1],
             transfer_function_line(loaded), view_line(view));
  for (const auto& note : file.notes) fmt::print("note      {}\n", note);
}

}  // namespace

void info(const std::filesystem::path& input, const io::MeshOptions& options, bool as_json) {
  const auto file = summary_of(read_input(input, options));
  const auto loaded = transfer_function_of(file.facts, RenderOptions{});
  if (!as_json) return print_text(input, file, loaded);

  auto json = mesh_json(input, file);
  const scene::ImageSize size;
  json["renders"] = {{"transfer_function", transfer_function_json(loaded)},
                     {"view", view_json(scene::frame_box(file.facts.box, size), size)}};
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace tessera::apps
