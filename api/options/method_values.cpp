// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>

#include "api/options/argument_values.hpp"
#include "api/options/choices.hpp"
#include "api/options/values.hpp"
#include "tessera/error.hpp"
#include "tessera/higher_order.hpp"
#include "tessera/program/method_words.hpp"

namespace tessera::api {
namespace {

/// Integrators of grids are given without numbers: --step sets their step length.
Integrator grid_integrator(const std::string& word) {
  Integrator integrator;
  for (const auto kind :
       {IntegratorKind::automatic, IntegratorKind::exact, IntegratorKind::sampled, IntegratorKind::preintegrated})
    if (integrator.kind = kind; word == method_word(kind)) return integrator;
  throw bad_input(
      fmt::format("`integrator`: '{}' is not for volumes; use auto, exact, sampled or preintegrated", word));
}

Integrator integrator_of(const OptionWords& words, bool is_grid) {
  Integrator integrator;
  const std::string& word = words.word("integrator");
  if (!word.empty()) integrator = is_grid ? grid_integrator(word) : parse_integrator("`integrator`", word);
  if (words.given("accuracy") && integrator.kind != IntegratorKind::automatic)
    throw bad_input(fmt::format("`accuracy`: it has no effect with `integrator` {}; leave one of the two out", word));
  assign(integrator.accuracy, words.positive("accuracy"));
  return integrator;
}

/// The shading of the options --shade and --light.
std::optional<Shading> shading_of(const OptionWords& words) {
  const std::string& light = words.word("light");
  if (!words.given("shade")) {
    if (light.empty()) return std::nullopt;
    throw bad_input("`light`: it has no effect without `shade`; add `shade`, or leave `light` out");
  }
  if (words.given("no-shade")) throw bad_input("`no_shade`: it contradicts `shade`; leave one of the two out");
  Shading shading;
  if (light.empty()) return shading;
  constexpr std::string_view world = "world:";
  shading.camera_light = !light.starts_with(world);
  shading.to_light = parse_vector("`light`", light.substr(shading.camera_light ? 0 : world.size()), false);
  if (shading.to_light == glm::dvec3(0))
    throw bad_input("`light`: 0,0,0 is not a direction; give the direction towards the light");
  return shading;
}

void set_mesh(const OptionWords& words, RenderOptions& options) {
  MeshSettings& mesh = options.settings.mesh;
  assign(mesh.rasterizer, words.choice("rasterizer", rasterizers));
  assign(mesh.tile_size, words.count("tile-size", 1, 1024));
  mesh.shading = shading_of(words);
  if (words.given("higher-order-tolerance")) return;
  options.higher_order_accuracy =
      words.given("accuracy") ? options.settings.integrator.accuracy : default_higher_order_accuracy;
  // Begin with the same tolerance as read_for_accuracy().
  options.read.higher_order_tolerance = first_higher_order_tolerance(*options.higher_order_accuracy);
}

void set_grid(const OptionWords& words, RenderOptions& options) {
  GridSettings& grid = options.settings.grid;
  if (words.given("step") && !takes_steps(options.settings.integrator))
    throw bad_input(
        fmt::format("`step`: it has no effect with `integrator` {}; use sampled or preintegrated, or leave it out",
                    method_word(options.settings.integrator.kind)));
  assign(grid.step, words.positive("step"));
  grid.shading = shading_of(words);
  assign(grid.brick_size, words.count("brick-size", 2, 1 << 20));
  assign(grid.edge_bricks, words.choice("edge-bricks", edge_brick_kinds));
  assign(grid.cache, words.choice("cache", cache_policies));
  if (words.given("preload") && grid.cache != CachePolicy::proximity)
    throw bad_input("`preload`: it has no effect without `cache` proximity; add that, or leave `preload` out");
  assign(grid.preload_limit, words.count("preload", 0, 1 << 20));
}

}  // namespace

void set_method(const OptionWords& words, RenderOptions& options) {
  Settings& settings = options.settings;
  settings.integrator = integrator_of(words, options.is_grid());
  assign(settings.emission, words.choice("emission", emissions));
  settings.threads = options.read.threads;
  assign(settings.memory_bytes, words.bytes("memory"));
  settings.use = parse_without("`without`", words.word("without")).use;
  settings.integrator.terminates = settings.use.termination;
  options.no_shade = words.given("no-shade");
  options.is_grid() ? set_grid(words, options) : set_mesh(words, options);
}

}  // namespace tessera::api
