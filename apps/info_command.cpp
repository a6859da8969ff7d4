#include "apps/info_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "apps/progress.hpp"
#include "apps/report.hpp"

namespace tessera::apps {
namespace {

std::string triple(const glm::dvec3& v) { return fmt::format("({:.9g} {:.9g} {:.9g})", v.x, v.y, v.z); }

std::string lattice_line(const GridGeometry& g) {
  std::string line = fmt::format("{}x{}x{} points, origin {}", g.points[0], g.points[1], g.points[2], triple(g.origin));
  if (g.rectilinear())
    line += ", rectilinear";
  else
    line += fmt::format(", spacing {}", triple(g.spacing));
  if (g.direction != glm::dmat3(1.0))
    line += fmt::format(", axes {} {} {}", triple(g.direction[0]), triple(g.direction[1]), triple(g.direction[2]));
  return line;
}

void print_text(const std::filesystem::path& input, const analysis::Description& data,
                const LoadedTransferFunction& loaded, const Camera& view) {
  fmt::print("file      {}\n", input.string());
  fmt::print("format    {}\n", data.format);
  if (data.is_mesh) {
    fmt::print("cells     {}\n", cells_line(data.counts));
    fmt::print("points    {}, {} of them in no cell kept\n", data.counts.points_read, data.counts.points_unused);
  } else {
    fmt::print("lattice   {}\n", lattice_line(data.geometry));
    fmt::print("samples   {}\n", samples_line(data));
  }
  fmt::print("bounds    {} to {}, diagonal {:.6g}\n", triple(data.box.low), triple(data.box.high), diagonal(data.box));
  std::size_t widest = 0;
  for (const auto& field : data.fields) widest = std::max(widest, field.name.size());
  const char* title = "fields";
  for (const auto& field : data.fields) {
    fmt::print("{:<9} {:<{}}  {:<5}  {:<7} x {}  {:.6g} to {:.6g}{}\n", title, field.name, widest,
               analysis::word(field.association), field.type, field.components, field.low, field.high,
               field.nan_count > 0 ? fmt::format(", {} NaN", field.nan_count) : "");
    title = "";
  }
  if (data.blocks.size() > 1) {
    constexpr std::size_t most = 200;
    std::string list;
    for (const auto& name : std::span(data.blocks).first(std::min(data.blocks.size(), most)))
      list += (list.empty() ? "" : ", ") + name;
    if (data.blocks.size() > most) list += fmt::format(" and {} more (--json has all)", data.blocks.size() - most);
    fmt::print("blocks    {}\n", list);
  }
  fmt::print("renders   field {}, {:.6g} to {:.6g}; {}; view {}\n", data.field_name, data.range[0], data.range[1],
             transfer_function_line(loaded), view_line(view));
  for (const auto& warning : data.warnings) fmt::print("warning   {}\n", warning);
  for (const auto& note : data.notes) fmt::print("note      {}\n", note);
}

void print_finding(const char* name, const MeshCheck::Finding& finding, const std::string& more = "",
                   bool pairs = false) {
  fmt::print("  {:<21} {}{}\n", name, finding.count, more);
  for (const auto& place : finding.places)
    fmt::print("    {}{} at ({:.9g} {:.9g} {:.9g}){}\n", place.cell,
               place.other != place.cell ? fmt::format(" and {}", place.other)
               : pairs                   ? " and itself"
                                         : "",
               place.at.x, place.at.y, place.at.z, place.value > 0 ? fmt::format(", {:.3g}", place.value) : "");
}

void print_check(const MeshCheck& check) {
  fmt::print("check     {} tets, {} points: {}\n", check.tets, check.points,
             check.clean() ? "every ray meets each place once"
                           : "cells overlap, fold or do not match; pictures are wrong where cells overlap");
  print_finding("overlapping pairs", check.overlaps,
                fmt::format("{}, {} cells", check.more_overlaps ? " or more" : "", check.overlapping_cells), true);
  print_finding("folded tets", check.inverted);
  print_finding("non-conforming faces", check.non_conforming_faces);
  print_finding("flat tets", check.flat);
  print_finding("slivers above 100:1", check.slivers,
                fmt::format(", {} above 1e4, {} above 1e6, worst {:.3g}", check.slivers_1e4, check.slivers_1e6,
                            check.worst_aspect));
  print_finding("duplicate points", check.duplicate_points);
  fmt::print("  {:<21} {} right-handed, {} left-handed\n", "orientation", check.right_handed, check.left_handed);
}

}  // namespace

void info(const std::filesystem::path& input, const ReadOptions& options, bool as_json, bool check) {
  StatusLine line(shows_progress(false));
  const Dataset data = open_watched(input, options, line);
  std::optional<MeshCheck> checked;
  if (check) {
    line.begin("checking " + input.filename().string());
    checked = data.check([&line](double done) { line.advance(done); });
  }
  line.begin("looking through " + input.filename().string());
  const analysis::Description description = described(data);
  const auto loaded = transfer_function_of(data, RenderOptions{});
  const ImageSize size;
  const Camera view = data.default_camera(size);
  line.begin("");
  if (!as_json) {
    print_text(input, description, loaded, view);
    if (checked) print_check(*checked);
    return;
  }
  auto json = analysis::data_json(input, description);
  json["renders"] = {{"transfer_function", analysis::transfer_function_json(loaded)},
                     {"view", analysis::view_json(view, size)}};
  if (checked) json["check"] = analysis::check_json(*checked);
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace tessera::apps
