// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>

#include "api/options/argument_values.hpp"
#include "api/options/choices.hpp"
#include "api/options/values.hpp"
#include "tessera/error.hpp"

namespace tessera::api {
namespace {

std::vector<Backend> backends_of(const std::string& words) {
  const auto known = find_option(Trait::render, "backend")->choices();
  std::vector<Backend> result;
  if (words.empty()) return result;
  for (const std::string& word : split_at_commas(words))
    result.push_back(backend_kinds.begin()[parse_choice("`backend`", word, known)]);
  return result;
}

}  // namespace

DeviceSettings device_settings(const OptionWords& words, bool for_volume) {
  DeviceSettings settings;
  static_cast<void>(words.choice("compositor"));
  const std::string& compositor = words.word("compositor");
  assign(settings.half, words.choice("framebuffer", on_off));
  if (words.given("framebuffer") && compositor != "gl-fragment")
    throw bad_input(
        "`framebuffer`: it is for `compositor` gl-fragment; leave `framebuffer` out, or use `compositor` gl-fragment");
  const bool asks_for_gl = compositor.starts_with("gl-");
  const std::vector<Backend> backends = backends_of(words.word("backend"));
  const auto is = [](Backend wanted) { return [wanted](Backend b) { return b == wanted; }; };
  const bool all_cpu = std::ranges::all_of(backends, is(Backend::cpu));
  const bool named = std::ranges::any_of(backends, [](Backend b) { return b == Backend::osmesa || b == Backend::egl; });
  if (compositor == "cpu" && named)
    throw bad_input(fmt::format("`backend` {}: `compositor` cpu does not use a backend; leave one of the two out",
                                words.word("backend")));
  if (for_volume && (asks_for_gl || named))
    throw bad_input("`compositor` and `backend`: volumes are rendered on the CPU; leave them out");
  if (asks_for_gl && !backends.empty() && all_cpu)
    throw bad_input(
        fmt::format("`backend` cpu: `compositor` {} needs osmesa, egl or auto; or use `compositor` cpu", compositor));
  if (words.given("egl-device")) {
    settings.by_local_rank = words.word("egl-device") == "local-rank";
    if (!settings.by_local_rank) settings.egl_device = words.count("egl-device", 0);
    if (std::ranges::none_of(backends, is(Backend::egl)) && std::ranges::none_of(backends, is(Backend::automatic)) &&
        !(asks_for_gl && backends.empty()))
      throw bad_input("`egl_device`: it is for `backend` egl; leave `egl_device` out, or use `backend` egl");
  }
  if (for_volume || compositor == "cpu" || (all_cpu && !asks_for_gl)) return settings;
  settings.backends = backends.empty() ? std::vector{Backend::automatic} : backends;
  if (compositor == "gl-fragment") settings.method = GlMethod::fragment;
  return settings;
}

}  // namespace tessera::api
