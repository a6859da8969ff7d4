// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/compositing_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>

#include "apps/options/argument_values.hpp"
#include "apps/options/render_options.hpp"
#include "tessera/error.hpp"

namespace tessera::apps {
namespace {

Backend backend_of(const std::string& word) {
  check_word("--backend", word, {"auto", "cpu", "osmesa", "egl"});
  return word == "auto"  ? Backend::automatic
         : word == "cpu" ? Backend::cpu
         : word == "egl" ? Backend::egl
                         : Backend::osmesa;
}

std::vector<Backend> backends_of(const std::string& words) {
  std::vector<Backend> backends;
  for (const std::string& word : split_at_commas(words)) backends.push_back(backend_of(word));
  return backends;
}

}  // namespace

void check_word(const char* option, const std::string& text, std::initializer_list<std::string_view> known) {
  if (std::find(known.begin(), known.end(), text) == known.end())
    throw bad_input(fmt::format("{}: '{}' is unknown; use {}", option, text, fmt::join(known, " or ")));
}

void add_compositing_options(CLI::App& command, RenderWords& words) {
  command
      .add_option(
          "--compositor", words.compositor,
          "who sorts and composites ray segments: the CPU (default), compute shaders, or fragment shaders as in "
          "the paper")
      ->type_name("cpu|gl-compute|gl-fragment");
  command
      .add_option("--backend", words.backend,
                  "where OpenGL comes from: auto is a GPU if one answers, else the CPU; under mpirun one word, or one "
                  "for each compositor: cpu,osmesa")
      ->type_name("auto|cpu|osmesa|egl");
  command.add_option("--framebuffer", words.framebuffer, "gl-fragment: 16-bit floats (default, as in the paper) or 32")
      ->type_name("half|float");
  command.add_option("--egl-device", words.egl_device, "egl: device by number, or by rank within its machine")
      ->type_name("N|local-rank");
}

DeviceSettings device_settings(const RenderWords& words, bool for_volume) {
  DeviceSettings settings;
  if (!words.compositor.empty()) check_word("--compositor", words.compositor, {"cpu", "gl-compute", "gl-fragment"});
  if (!words.framebuffer.empty()) {
    check_word("--framebuffer", words.framebuffer, {"half", "float"});
    if (words.compositor != "gl-fragment")
      throw bad_input("--framebuffer: is for --compositor gl-fragment; leave one of the two out");
  }
  const bool asks_for_gl = words.compositor.starts_with("gl-");
  std::vector<Backend> backends;
  if (!words.backend.empty()) backends = backends_of(words.backend);
  const auto is = [](Backend wanted) { return [wanted](Backend b) { return b == wanted; }; };
  const bool all_cpu = std::all_of(backends.begin(), backends.end(), is(Backend::cpu));
  const bool named = std::any_of(backends.begin(), backends.end(),
                                 [](Backend b) { return b == Backend::osmesa || b == Backend::egl; });
  if (words.compositor == "cpu" && named)
    throw bad_input(fmt::format("--backend {}: --compositor cpu needs none; leave one of the two out", words.backend));
  if (for_volume && (asks_for_gl || named))
    throw bad_input("--compositor and --backend: volumes are cast on the CPU; leave them out");
  if (asks_for_gl && !backends.empty() && all_cpu)
    throw bad_input(fmt::format("--backend cpu: --compositor {} needs osmesa, egl or auto; or use --compositor cpu",
                                words.compositor));
  if (!words.egl_device.empty()) {
    if (words.egl_device == "local-rank")
      settings.by_local_rank = true;
    else
      settings.egl_device = parse_count("--egl-device", words.egl_device, 0, std::numeric_limits<int>::max());
    if (std::none_of(backends.begin(), backends.end(), is(Backend::egl)) &&
        std::none_of(backends.begin(), backends.end(), is(Backend::automatic)) && !(asks_for_gl && backends.empty()))
      throw bad_input("--egl-device: is for --backend egl; leave one of the two out");
  }
  if (for_volume || words.compositor == "cpu" || (all_cpu && !asks_for_gl)) return settings;
  settings.backends = backends.empty() ? std::vector{Backend::automatic} : backends;
  if (words.compositor == "gl-fragment") settings.method = GlMethod::fragment;
  settings.half = words.framebuffer != "float";
  return settings;
}

}  // namespace tessera::apps
