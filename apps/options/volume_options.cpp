// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/volume_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>

#include "apps/options/argument_values.hpp"
#include "apps/options/method_words.hpp"
#include "apps/options/time_options.hpp"
#include "tessera/error.hpp"
#include "tessera/input_file.hpp"
#include "tessera/settings.hpp"

namespace tessera::apps {
namespace {

/// Three values between the separators.
template <class T, class Parse>
std::array<T, 3> three(const std::string& option, const std::string& text, char separator, const char* allowed,
                       const Parse& parse) {
  std::array<T, 3> values{};
  std::size_t at = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t stop = k < 2 ? text.find(separator, at) : text.size();
    if (stop == std::string::npos) throw bad_input(fmt::format("{}: '{}' is not {}", option, text, allowed));
    values[k] = parse(text.substr(at, stop - at));
    at = stop + 1;
  }
  return values;
}

}  // namespace

void add_volume_options(CLI::App& command, RenderWords& words) {
  command.add_option("--dims", words.dims, ".raw: samples along x, y, z (or NAME_WxHxD_uint8.raw)")->type_name("WxHxD");
  command.add_option("--type", words.type, ".raw: uint8, int16, uint16, float32, ...")->type_name("TYPE");
  command.add_option("--spacing", words.spacing, ".raw: world units between samples (default 1,1,1)")
      ->type_name("X,Y,Z");
  command.add_option("--origin", words.origin, ".raw: world position of the first sample (default 0,0,0)")
      ->type_name("X,Y,Z");
  command.add_option("--endian", words.endian, ".raw: byte order (default little)")->type_name("little|big");
  command.add_option("--skip", words.skip, ".raw: bytes before the first sample")->type_name("BYTES");
}

void add_volume_render_options(CLI::App& command, RenderWords& words) {
  command
      .add_option("--labels", words.labels,
                  "volumes: whether values are labels, each of which fills its sample's voxel (default: by the header "
                  "or the values)")
      ->type_name("on|off");
  command.add_option("--step", words.step, "volumes: length of a step of sampled and preintegrated (default 0.5)")
      ->type_name("VOXELS");
  command.add_flag("--shade", words.shade,
                   "Blinn-Phong by the field's gradient, with a light at the camera, or --light");
  command.add_flag("--no-shade", words.no_shade, "volumes: not even a scan of a patient, which else is shaded");
  command
      .add_option("--light", words.light,
                  "--shade: towards the light; to the right, up and towards the eye, or along the world's axes "
                  "(default 0,0,1)")
      ->type_name("[world:]X,Y,Z");
  command.add_option("--brick-size", words.brick_size, "volumes: voxels a side of a brick (default 32)")
      ->type_name("VOXELS");
  command
      .add_option("--edge-bricks", words.edge_bricks,
                  "volumes: memory of a brick at the end of an axis, as much as of the others or as it needs (default "
                  "variable)")
      ->type_name("fixed|variable");
  command.add_option("--cache", words.cache, "volumes: which brick goes first when memory is full (default lru)")
      ->type_name("lru|proximity");
  command
      .add_option("--preload", words.preload,
                  "volumes, --cache proximity: bricks that the next view will need, loaded ahead, a frame (default 0)")
      ->type_name("BRICKS");
  command
      .add_option("--distribution", words.distribution,
                  "volumes, under mpirun: each process a part of the picture, or of the volume (default sort-first)")
      ->type_name("sort-first|sort-last");
  command
      .add_option("--direct-send", words.direct_send,
                  "--distribution sort-last: how processes exchange pixels (default asynchronous)")
      ->type_name("asynchronous|synchronous");
  command
      .add_option("--balance", words.balance,
                  "volumes, under mpirun: how the picture is split between processes (default learned)")
      ->type_name("learned|accurate|backface|splatting|previous|even");
  command
      .add_option("--balance-resolution", words.balance_resolution,
                  "volumes: of the cost map, its pixels an image pixel along each axis (default 0.5; learned splits by "
                  "0.25 at most)")
      ->type_name("FACTOR");
  command
      .add_option("--balance-weights", words.balance_weights,
                  "volumes, under mpirun: how much of the work each process gets (default: all the same)")
      ->type_name("W,W,...|measured");
  command
      .add_option("--show", words.show,
                  "volumes: bricks drawn in the colours of the processes, and the cost map as a second picture")
      ->type_name("balance");
}

std::optional<glm::dvec3> axis_scale_of(const RenderWords& words) {
  if (words.axis_scale.empty()) return std::nullopt;
  return parse_vector("--scale", words.axis_scale, true);
}

ReadOptions volume_options(const RenderWords& words) {
  ReadOptions options;
  options.field = words.field;
  options.axis_scale = axis_scale_of(words);
  options.time_step = one_time_step(words.time_step);
  options.blocks = words.blocks;
  options.selection = selection_of(words.clip);
  options.memory_bytes = words.memory.empty() ? Settings().memory_bytes : parse_bytes("--memory", words.memory);
  if (!words.dims.empty())
    options.dims =
        three<std::int64_t>("--dims", words.dims, 'x', "three sizes; write WxHxD", [](const std::string& word) {
          return std::int64_t{parse_count("--dims", word, 1, std::numeric_limits<int>::max())};
        });
  if (!words.type.empty()) {
    options.type = sample_type_named(words.type);
    if (!options.type)
      throw bad_input(fmt::format(
          "--type: '{}' is unknown; use int8, uint8, int16, uint16, int32, uint32, float32 or float64", words.type));
  }
  if (!words.spacing.empty()) options.spacing = parse_vector("--spacing", words.spacing, true);
  if (!words.origin.empty()) options.origin = parse_vector("--origin", words.origin, false);
  if (!words.endian.empty() && words.endian != "little" && words.endian != "big")
    throw bad_input(fmt::format("--endian: '{}' is unknown; use little or big", words.endian));
  options.big_endian = words.endian == "big";
  if (!words.labels.empty() && words.labels != "on" && words.labels != "off")
    throw bad_input(fmt::format("--labels: '{}' is unknown; use on or off", words.labels));
  if (!words.labels.empty()) options.labels = words.labels == "on";
  if (!words.skip.empty())
    options.skip = static_cast<std::uint64_t>(parse_count("--skip", words.skip, 0, std::numeric_limits<int>::max()));
  return options;
}

bool is_grid_input(const RenderWords& words) {
  return volume_options(words).describes_raw() || opens_as_grid(words.input);
}

std::optional<Shading> shading_of(const RenderWords& words) {
  if (!words.shade && words.light.empty()) return std::nullopt;
  if (!words.shade) throw bad_input("--light: has no effect without --shade; add it, or leave --light out");
  Shading shading;
  if (words.light.empty()) return shading;
  constexpr std::string_view world = "world:";
  shading.camera_light = !words.light.starts_with(world);
  shading.to_light = parse_vector("--light", words.light.substr(shading.camera_light ? 0 : world.size()), false);
  if (shading.to_light == glm::dvec3(0))
    throw bad_input("--light: 0,0,0 is no direction; say which way the light lies");
  return shading;
}

void set_grid(const RenderWords& words, Settings& settings) {
  const std::string& method = words.integrator;
  Integrator& integrator = settings.integrator;
  GridSettings& grid = settings.grid;
  const auto kinds = {IntegratorKind::automatic, IntegratorKind::exact, IntegratorKind::sampled,
                      IntegratorKind::preintegrated};
  const auto* const kind = std::ranges::find_if(kinds, [&](IntegratorKind k) { return method == method_word(k); });
  if (kind == kinds.end())
    throw bad_input(
        fmt::format("--integrator: '{}' is none for volumes; use auto, exact, sampled or preintegrated", method));
  integrator.kind = *kind;
  if (!words.accuracy.empty()) {
    if (integrator.kind != IntegratorKind::automatic)
      throw bad_input(fmt::format("--accuracy: has no effect with --integrator {}; leave one of the two out", method));
    integrator.accuracy = parse_positive("--accuracy", words.accuracy);
  }
  if (!words.step.empty()) {
    if (!takes_steps(settings.integrator))
      throw bad_input(
          fmt::format("--step: has no effect with --integrator {}; use sampled or preintegrated, or "
                      "leave it out",
                      method));
    grid.step = parse_positive("--step", words.step);
  }
  if (words.shade && words.no_shade) throw bad_input("--no-shade: contradicts --shade; leave one of the two out");
  grid.shading = shading_of(words);
  if (!words.brick_size.empty()) grid.brick_size = parse_count("--brick-size", words.brick_size, 2, 1 << 20);
  if (words.edge_bricks == "fixed")
    grid.edge_bricks = EdgeBricks::fixed;
  else if (!words.edge_bricks.empty() && words.edge_bricks != "variable")
    throw bad_input(fmt::format("--edge-bricks: '{}' is unknown; use fixed or variable", words.edge_bricks));
  if (words.cache == "proximity")
    grid.cache = CachePolicy::proximity;
  else if (!words.cache.empty() && words.cache != "lru")
    throw bad_input(fmt::format("--cache: '{}' is unknown; use lru or proximity", words.cache));
  if (!words.preload.empty()) {
    if (grid.cache != CachePolicy::proximity)
      throw bad_input("--preload: has no effect without --cache proximity; add it, or leave --preload out");
    grid.preload_limit = parse_count("--preload", words.preload, 0, 1 << 20);
  }
}

void set_distribution(const RenderWords& words, RankSettings& ranks) {
  const auto chosen = [](const char* option, const std::string& word, const char* first, const char* second) {
    if (!word.empty() && word != first && word != second)
      throw bad_input(fmt::format("{}: '{}' is unknown; use {} or {}", option, word, first, second));
    return word == second;
  };
  if (chosen("--distribution", words.distribution, "sort-first", "sort-last"))
    ranks.distribution = Distribution::sort_last;
  if (chosen("--direct-send", words.direct_send, "asynchronous", "synchronous"))
    ranks.direct_send = DirectSend::synchronous;
  const bool sorts_last = ranks.distribution == Distribution::sort_last;
  if (!sorts_last && !words.direct_send.empty())
    throw bad_input("--direct-send: has no effect without --distribution sort-last; add it, or leave it out");
  const std::pair<const char*, bool> of_sort_first[] = {{"--balance", !words.balance.empty()},
                                                        {"--balance-resolution", !words.balance_resolution.empty()},
                                                        {"--balance-weights", !words.balance_weights.empty()}};
  for (const auto& [option, is_given] : of_sort_first)
    if (sorts_last && is_given)
      throw bad_input(fmt::format(
          "{}: has no effect with --distribution sort-last, which splits the volume; leave one of the two out",
          option));
}

void set_balance(const RenderWords& words, RankSettings& ranks) {
  constexpr std::pair<const char*, Balance> known[] = {
      {"learned", Balance::learned},     {"accurate", Balance::accurate}, {"backface", Balance::backface},
      {"splatting", Balance::splatting}, {"previous", Balance::previous}, {"even", Balance::even}};
  const auto* const found =
      std::ranges::find_if(known, [&](const auto& choice) { return words.balance == choice.first; });
  if (found != std::end(known))
    ranks.balance = found->second;
  else if (!words.balance.empty())
    throw bad_input(fmt::format(
        "--balance: '{}' is unknown; use learned, accurate, backface, splatting, previous or even", words.balance));
  if (!words.balance_resolution.empty()) {
    ranks.balance_resolution = parse_positive("--balance-resolution", words.balance_resolution);
    if (ranks.balance_resolution > 1 || ranks.balance_resolution < 1e-3)
      throw bad_input(fmt::format("--balance-resolution: {} is not from 0.001 to 1", words.balance_resolution));
  }
  if (!words.show.empty() && words.show != "balance")
    throw bad_input(fmt::format("--show: '{}' is unknown; use balance", words.show));
  ranks.balance_measured = words.balance_weights == "measured";
  if (!words.balance_weights.empty() && !ranks.balance_measured)
    for (const std::string& weight : split_at_commas(words.balance_weights))
      ranks.balance_weights.push_back(parse_positive("--balance-weights", weight));
}

void refuse_mesh_words(const RenderWords& words) {
  const std::pair<const char*, bool> given[] = {{"--projectors", !words.projectors.empty()},
                                                {"--compositors", !words.compositors.empty()},
                                                {"--exchange", !words.exchange.empty()},
                                                {"--partition", words.partition != "curve"},
                                                {"--seed", !words.seed.empty()},
                                                {"--tile-size", !words.tile_size.empty()}};
  for (const auto& [option, is_given] : given)
    if (is_given) {
      require_input(words.input);  // one that is not there is neither
      throw bad_input(fmt::format("{}: is for meshes, and the input is a volume; leave it out", option));
    }
}

void refuse_volume_options(const RenderWords& words) {
  const std::pair<const char*, bool> given[] = {{"--step", !words.step.empty()},
                                                {"--labels", !words.labels.empty()},
                                                {"--no-shade", words.no_shade},
                                                {"--brick-size", !words.brick_size.empty()},
                                                {"--edge-bricks", !words.edge_bricks.empty()},
                                                {"--cache", !words.cache.empty()},
                                                {"--preload", !words.preload.empty()},
                                                {"--distribution", !words.distribution.empty()},
                                                {"--direct-send", !words.direct_send.empty()},
                                                {"--balance", !words.balance.empty()},
                                                {"--balance-resolution", !words.balance_resolution.empty()},
                                                {"--balance-weights", !words.balance_weights.empty()},
                                                {"--show", !words.show.empty()}};
  for (const auto& [option, is_given] : given)
    if (is_given) {
      require_input(words.input);  // one that is not there is neither
      throw bad_input(fmt::format("{}: is for volumes, and the input is a mesh; leave it out", option));
    }
}

}  // namespace tessera::apps
