// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/method_preset.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>

#include "apps/options/argument_values.hpp"
#include "apps/options/compositing_options.hpp"
#include "tessera/dataset.hpp"
#include "tessera/error.hpp"
#include "tessera/program/nearest_name.hpp"

namespace tessera::apps {
namespace {

/// Pixels a side of tiles of which 16 lie along the longer side of the picture.
std::string tile_side(const std::string& size) {
  const ImageSize picture = size.empty() ? ImageSize() : parse_size("--size", size);
  return std::to_string(std::min((std::max(picture.width, picture.height) + 15) / 16, 1024));
}

}  // namespace

void add_method_preset_option(CLI::App& render, RenderWords& words) {
  render
      .add_option("--preset", words.preset,
                  "a published method as a whole: scanline, raw segments, sampled:4, gl-fragment, 16x16 tiles, "
                  "processes in two roles; options beside it win")
      ->type_name("juliachs-2007");
}

void apply_method_preset(const CLI::App& render, int ranks, RenderWords& words) {
  if (words.preset.empty()) return;
  if (const auto colors = nearest_name(words.preset, preset_names()))  // what other programs call a preset
    throw bad_input(fmt::format("--preset: '{}' is no published method; for colours write --transfer-function {}",
                                words.preset, *colors));
  check_word("--preset", words.preset, {"juliachs-2007"});
  const auto set = [&](const char* option, std::string& word, const std::string& value) {
    if (render.get_option(option)->count() == 0) word = value;
  };
  set("--rasterizer", words.rasterizer, "scanline");
  // An accuracy is of `auto`, so whoever asks for one asks for that.
  if (render.get_option("--accuracy")->count() == 0) set("--integrator", words.integrator, "sampled:4");
  set("--compositor", words.compositor, "gl-fragment");
  if (words.compositor != "cpu") set("--backend", words.backend, "osmesa");
  if (words.compositor == "gl-fragment") set("--framebuffer", words.framebuffer, "half");
  set("--tile-size", words.tile_size, tile_side(words.size));
  if (ranks < 2) return;
  set("--exchange", words.exchange, "segments");
  set("--without", words.without, "sharing");
  if (render.get_option("--compositors")->count() == 0)
    set("--projectors", words.projectors, std::to_string((ranks + 1) / 2));
}

}  // namespace tessera::apps
