#include "apps/info_command.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apps/report.hpp"
#include "apps/session_options.hpp"
#include "frame/mesh_input.hpp"
#include "tessera/mesh_check.hpp"

namespace tessera::apps {
namespace {

void print_text(const std::filesystem::path& input, const Description& file, const LoadedTransferFunction& loaded) {
  const auto& counts = file.counts;
  const auto& box = file.box;
  fmt::print("file      {}\n", input.string());
  fmt::print("format    {}\n", file.format);
  fmt::print("cells     {}\n", cells_line(counts));
  fmt::print("points    {}, {} of them in no cell kept\n", counts.points_read, counts.points_unused);
  fmt::print("bounds    ({:.9g} {:.9g} {:.9g}) to ({:.9g} {:.9g} {:.9g}), diagonal {:.6g}\n", box.low.x, box.low.y,
             box.low.z, box.high.x, box.high.y, box.high.z, frame::diagonal(box));
  std::size_t widest = 0;
  for (const auto& field : file.fields) widest = std::max(widest, field.name.size());
  const char* title = "fields";
  for (const auto& field : file.fields) {
    fmt::print("{:<9} {:<{}}  {:<5}  {:<7} x {}  {:.6g} to {:.6g}{}\n", title, field.name, widest,
               field.association == scene::Association::point ? "point" : "cell", field.type, field.components,
               field.low, field.high, field.nan_count > 0 ? fmt::format(", {} NaN", field.nan_count) : "");
    title = "";
  }
  const auto& range = file.range;
  const auto view = scene::frame_box(box, scene::ImageSize{});
  fmt::print("renders   field {}, {:.6g} to {:.6g}; {}; view {}\n", file.field_name, range[0], range[1],
             transfer_function_line(loaded), view_line(view));
  for (const auto& note : file.notes) fmt::print("note      {}\n", note);
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

nlohmann::ordered_json finding_json(const MeshCheck::Finding& finding) {
  nlohmann::ordered_json places = nlohmann::ordered_json::array();
  for (const auto& place : finding.places) {
    nlohmann::ordered_json json = {{"id", place.cell}};
    if (place.other != place.cell) json["other"] = place.other;
    json["at"] = {place.at.x, place.at.y, place.at.z};
    if (place.value > 0) json["value"] = place.value;
    places.push_back(json);
  }
  return {{"count", finding.count}, {"places", places}};
}

nlohmann::ordered_json check_json(const MeshCheck& check) {
  nlohmann::ordered_json json = {{"tets", check.tets}, {"points", check.points}, {"clean", check.clean()}};
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

}  // namespace

void info(const std::filesystem::path& input, const io::MeshOptions& options, bool as_json, bool check) {
  const Dataset data = Dataset::open(input, read_options(options));
  std::optional<MeshCheck> checked;
  if (check) checked = data.check();
  const Description file(data);
  const auto loaded = transfer_function_of(data, RenderOptions{});
  if (!as_json) {
    print_text(input, file, loaded);
    if (checked) print_check(*checked);
    return;
  }

  auto json = data_json(input, file);
  const scene::ImageSize size;
  json["renders"] = {{"transfer_function", transfer_function_json(loaded)},
                     {"view", view_json(data.default_camera(size), size)}};
  if (checked) json["check"] = check_json(*checked);
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace tessera::apps
