// SPDX-License-Identifier: BSD-3-Clause
// The reverse of *_values.cpp: each function there that reads words has one here that writes them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "api/options/choices.hpp"
#include "tessera/error.hpp"
#include "tessera/program/method_words.hpp"
#include "tessera/program/options.hpp"
#include "tessera/state.hpp"

namespace tessera {
namespace api {
namespace {

/// These functions return the shortest text that reads back the same.
std::string text_of(double number) { return fmt::format("{}", number); }
std::string text_of(const glm::dvec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }
std::string text_of(const std::array<double, 2>& ends) { return fmt::format("{},{}", ends[0], ends[1]); }
std::string text_of(std::uint64_t number) { return fmt::format("{}", number); }
std::string text_of(int number) { return fmt::format("{}", number); }

template <class T>
std::string text_of(const std::optional<T>& value) {
  return value ? text_of(*value) : std::string();
}

/// Returns the text of `value`, or "", which removes the option, if it is the default.
template <class T>
std::string unless_default(const T& value, const T& by_default) {
  return value == by_default ? std::string() : text_of(value);
}

std::string on_one_line(const std::string& json) { return nlohmann::json::parse(json).dump(); }

std::string flag(bool is_set) { return is_set ? "true" : ""; }

/// The word of `option` that means `value`.
template <class T>
std::string word_of(std::string_view option, const T& value, Choices<T> values) {
  const auto at = std::find(values.begin(), values.end(), value) - values.begin();
  return std::string(find_option(Trait::render, option)->choices()[static_cast<std::size_t>(at)]);
}
template <class T>
std::string word_unless(std::string_view option, const T& value, const T& by_default, Choices<T> values) {
  return value == by_default ? std::string() : word_of(option, value, values);
}

std::string place_word(Place place) {
  return std::string(std::ranges::find(places, place, &std::pair<std::string_view, Place>::second)->first);
}

Error unstated(const char* setting, const char* what) {
  return bad_input(fmt::format("`{}`: {}, which no option can express; give it to the session", setting, what));
}

std::string look_text(const std::optional<glm::dvec3>& color, double opacity) {
  std::string text = color ? ":" + text_of(*color) : "";
  if (opacity != 1) text += fmt::format("{}:{}", color ? "" : ":", opacity);
  return text;
}

void set_raw(State& state, const ReadOptions& read) {
  state.set("dims", read.dims ? fmt::format("{}x{}x{}", (*read.dims)[0], (*read.dims)[1], (*read.dims)[2]) : "");
  state.set("type", read.type ? name_of(*read.type) : "");
  state.set("spacing", text_of(read.spacing));
  state.set("origin", text_of(read.origin));
  state.set("endian", word_unless("endian", read.big_endian, false, off_on));
  state.set("skip", unless_default(read.skip, std::uint64_t{0}));
}

void set_shading(State& state, const std::optional<Shading>& shading, DataKind kind) {
  state.set("shade", flag(shading.has_value()));
  state.set("no-shade", flag(!shading && kind == DataKind::grid));
  state.set("light", std::string());
  if (!shading) return;
  Shading plain;
  plain.to_light = shading->to_light;
  plain.camera_light = shading->camera_light;
  if (plain != *shading) throw unstated("shade", "other coefficients than the default ones");
  if (*shading != Shading{})
    state.set("light", fmt::format("{}{}", plain.camera_light ? "" : "world:", text_of(plain.to_light)));
}

void set_surfaces(State& state, const Surfaces& surfaces) {
  if (surfaces.light != SurfaceLight{}) throw unstated("surface", "another light than the default one");
  if (!surfaces.triangles.empty()) throw unstated("surface", "triangles in memory");
  std::vector<std::string> iso, boundary;
  for (const IsoSurface& each : surfaces.iso) iso.push_back(text_of(each.value) + look_text(each.color, each.opacity));
  for (const BoundarySurface& each : surfaces.boundary)
    boundary.push_back("boundary" + look_text(each.color, each.opacity));
  state.set("iso", iso);
  state.set("surface", boundary);
}

void set_device(State& state, const DeviceSettings& device) {
  const bool is_fragment = device.method == GlMethod::fragment;
  std::vector<std::string> backends;
  for (const Backend each : device.backends) backends.push_back(word_of("backend", each, backend_kinds));
  const bool is_used = !backends.empty();
  state.set("compositor", is_used ? (is_fragment ? "gl-fragment" : "gl-compute") : "");
  state.set("backend", fmt::format("{}", fmt::join(backends, ",")));
  state.set("framebuffer", is_used && is_fragment ? word_unless("framebuffer", device.half, true, on_off) : "");
  state.set("egl-device", device.by_local_rank ? "local-rank" : text_of(device.egl_device));
}

void set_integrator(State& state, const Settings& settings, DataKind kind) {
  const Integrator& integrator = settings.integrator;
  const bool is_automatic = integrator.kind == IntegratorKind::automatic;
  const std::string word = kind == DataKind::mesh ? method_line(integrator) : method_word(integrator.kind);
  state.set("integrator", is_automatic ? "" : word);
  state.set("accuracy", is_automatic ? unless_default(integrator.accuracy, Integrator().accuracy) : "");
  state.set("emission", word_unless("emission", settings.emission, Emission::absorption, emissions));
  std::vector<std::string_view> without;
  for (const auto& [name, mechanism] : mechanisms)
    if (!(settings.use.*mechanism) || (name == "termination" && !integrator.terminates)) without.push_back(name);
  state.set("without", fmt::format("{}", fmt::join(without, ",")));
}

void set_mesh(State& state, const MeshSettings& mesh) {
  const MeshSettings by_default;
  state.set("rasterizer", word_unless("rasterizer", mesh.rasterizer, by_default.rasterizer, rasterizers));
  state.set("tile-size", unless_default(mesh.tile_size, by_default.tile_size));
  set_device(state, mesh.device);
  set_shading(state, mesh.shading, DataKind::mesh);
}

void set_grid(State& state, const GridSettings& grid) {
  const GridSettings by_default;
  state.set("step", unless_default(grid.step, by_default.step));
  state.set("brick-size", unless_default(grid.brick_size, by_default.brick_size));
  state.set("edge-bricks", word_unless("edge-bricks", grid.edge_bricks, by_default.edge_bricks, edge_brick_kinds));
  state.set("cache", word_unless("cache", grid.cache, by_default.cache, cache_policies));
  state.set("preload", unless_default(grid.preload_limit, by_default.preload_limit));
  set_shading(state, grid.shading, DataKind::grid);
}

void set_mesh_ranks(State& state, const RankSettings& ranks) {
  const RankSettings by_default;
  state.set("projectors", text_of(ranks.projectors));
  state.set("compositors", text_of(ranks.compositors));
  state.set("exchange", ranks.exchange ? word_of("exchange", *ranks.exchange, exchanges) : "");
  state.set("partition", word_unless("partition", ranks.partition.kind, by_default.partition.kind, partition_kinds));
  if (ranks.tile_seed != ranks.partition.seed)
    throw unstated("seed", "the tile map and the partition have different seeds");
  state.set("seed", unless_default(ranks.tile_seed, by_default.tile_seed));
}

void set_grid_ranks(State& state, const RankSettings& ranks) {
  const RankSettings by_default;
  state.set("distribution", word_unless("distribution", ranks.distribution, by_default.distribution, distributions));
  state.set("direct-send", word_unless("direct-send", ranks.direct_send, by_default.direct_send, direct_sends));
  state.set("balance", word_unless("balance", ranks.balance, by_default.balance, balances));
  state.set("balance-resolution", unless_default(ranks.balance_resolution, by_default.balance_resolution));
  state.set("balance-weights",
            ranks.balance_measured ? "measured" : fmt::format("{}", fmt::join(ranks.balance_weights, ",")));
}

}  // namespace
}  // namespace api

inline namespace v0_1 {

void State::set(const ReadOptions& read) {
  set("field", read.field);
  set("smooth", api::flag(read.smooth));
  if (read.warp)
    set("warp", read.warp->vector.empty() ? "off" : fmt::format("{}:{}", read.warp->vector, read.warp->factor));
  else
    set("warp", std::string());
  set("q", read.plot3d_q.string());
  set("max-volume", api::text_of(read.max_volume));
  set("time-step", api::text_of(read.time_step));
  set("block", read.blocks);
  set("drop-duplicates", api::flag(read.drop_duplicates));
  set("scale", api::text_of(read.axis_scale));
  std::vector<std::string> clips;
  for (const HalfSpace& half : read.selection.clip)
    clips.push_back(fmt::format("{},{}", api::text_of(half.point), api::text_of(half.normal)));
  set("clip", std::move(clips));
  set("threshold", api::text_of(read.selection.threshold));
  set("higher-order-tolerance", api::unless_default(read.higher_order_tolerance, default_higher_order_tolerance));
  set("higher-order-tets", api::unless_default(read.higher_order_tets, default_higher_order_tets));
  set("labels", read.labels ? api::word_of("labels", *read.labels, api::on_off) : "");
  if (read.threads != 0) set("threads", api::text_of(read.threads));
  api::set_raw(*this, read);
}

void State::set(const Settings& settings, DataKind kind) {
  api::set_integrator(*this, settings, kind);
  api::set_surfaces(*this, settings.surfaces);
  set("threads", api::unless_default(settings.threads, 0));
  set("memory", api::unless_default(settings.memory_bytes, Settings().memory_bytes));
  set("frames-in-flight", api::unless_default(settings.ranks.frames_in_flight, RankSettings().frames_in_flight));
  if (kind == DataKind::mesh) {
    api::set_mesh(*this, settings.mesh);
    api::set_mesh_ranks(*this, settings.ranks);
  } else {
    api::set_grid(*this, settings.grid);
    api::set_grid_ranks(*this, settings.ranks);
  }
}

void State::set(const TransferFunction& function) {
  for (const OptionRow* row : option_rows(Trait::knots)) set(row->key(), std::string());
  set("transfer-function", api::on_one_line(transfer_function_json(function)));
}

void State::set(const View& view) {
  for (const OptionRow* row : option_rows(Trait::view)) set(row->key(), std::string());
  set("size", std::string());
  set("camera", api::on_one_line(camera_json({view.camera, view.size})));
}

void State::set(const Annotation& annotation) {
  for (const OptionRow* row : option_rows(Trait::annotation)) set(row->key(), std::vector<std::string>());
  const AnnotationStyle& style = annotation.style;
  if (const auto& bar = annotation.color_bar) {
    set("color-bar", bar->place == Place::right ? "true" : api::place_word(bar->place));
    set("color-bar-title", bar->title);
    set("color-bar-range", api::text_of(bar->range));
    set("color-bar-scale", api::word_of("color-bar-scale", bar->logarithmic, api::off_on));
  }
  const auto& axes = annotation.axes;
  if (axes && axes->place != Place::bottom_left) throw api::unstated("axes", "at another place than bottom-left");
  if (axes && (axes->triad || axes->box)) set("axes", axes->triad ? (axes->box ? "both" : "triad") : "box");
  set("outline", api::flag(annotation.outline.has_value()));
  if (annotation.scale_bar) set("scale-bar", api::place_word(annotation.scale_bar->place));
  std::vector<std::string> texts;
  for (const Text& text : annotation.texts) texts.push_back(api::place_word(text.place) + ":" + text.text);
  set("annotate", std::move(texts));
  if ((axes && axes->box) || annotation.scale_bar) set("length-unit", style.length_unit);
  const bool draws = std::ranges::any_of(option_rows(Trait::annotation),
                                         [&](const OptionRow* row) { return words_.contains(row->key()); });
  if (!draws) return;
  set("annotation-color", api::text_of(style.ink));
  set("annotation-size", api::text_of(style.text_size));
}

void State::set(const ImageFileOptions& image) {
  set("half", api::flag(image.half));
  set("png-bits", api::word_unless("png-bits", image.png_bits, 8, api::png_depths));
  set("blend", api::word_unless("blend", !image.encode_srgb, false, api::off_on));
  set("background", api::text_of(image.background));
}

}  // namespace v0_1
}  // namespace tessera
