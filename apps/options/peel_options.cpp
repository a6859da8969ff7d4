// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/peel_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <optional>

#include "apps/options/method_words.hpp"
#include "tessera/error.hpp"
#include "tessera/image_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::apps {
namespace {

constexpr int most_layers = 64;

[[noreturn]] void refuse(const std::string& word, const std::string& problem) {
  throw bad_input(fmt::format("--peel: '{}' {}; write THRESHOLD[:LAYERS], like 0.95:4", word, problem));
}

Peel parse_peel(const std::string& word) {
  const std::size_t colon = word.find(':');
  Peel peel;
  const std::optional<double> threshold = number_of<double>(word.substr(0, colon));
  if (!threshold || !(*threshold > 0 && *threshold < 1))
    refuse(word, "has no threshold, an opacity above 0 and below 1");
  peel.threshold = *threshold;
  if (colon == std::string::npos) return peel;
  const std::optional<double> layers = number_of<double>(word.substr(colon + 1));
  if (!layers || *layers != std::floor(*layers) || !(*layers >= 1 && *layers <= most_layers))
    refuse(word, fmt::format("has no number of layers, 1 to {}", most_layers));
  peel.layers = static_cast<int>(*layers);
  return peel;
}

}  // namespace

void add_peel_options(CLI::App& command, std::string& word) {
  command
      .add_option("--peel", word,
                  "the picture in layers too, a cut wherever a ray's opacity since the last cut reaches THRESHOLD: "
                  "a.exr has a.layer1.exr ..., a .deep.exr has a sample a layer (default: 4 layers)")
      ->type_name("THRESHOLD[:LAYERS]");
}

void set_peel(const RenderWords& words, RenderOptions& options) {
  if (words.peel.empty()) return;
  options.frame.peel = parse_peel(words.peel);
  if (!options.films.empty())
    throw bad_input(fmt::format("--peel: {} cannot hold layers; name pictures, as -o a_%04d.png, or leave --peel out",
                                options.films.front().string()));
  if (options.to_standard_output)
    throw bad_input("--peel: standard output takes one picture; name a file with -o, or leave --peel out");
  if (options.show_balance) throw bad_input("--peel: --show balance draws no layers; leave one of the two out");
  if (!words.deep_accuracy.empty())
    throw bad_input("--deep-accuracy: has no effect on the layers of --peel; leave one of the two out");
  const Integrator& integrator = options.settings.integrator;
  if (integrator.kind != IntegratorKind::automatic && integrator.kind != IntegratorKind::exact)
    throw bad_input(fmt::format("--peel: --integrator {} gives a segment other light than its parts; use auto or exact",
                                method_word(integrator.kind)));
}

}  // namespace tessera::apps
