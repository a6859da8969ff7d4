// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/options/choices.hpp"
#include "api/options/values.hpp"
#include "tessera/error.hpp"
#include "tessera/film_file.hpp"
#include "tessera/program/method_words.hpp"
#include "tessera/program/text.hpp"

namespace tessera::api {
namespace {

constexpr int most_layers = 64;

[[noreturn]] void refuse_peel(const std::string& word, const std::string& problem) {
  throw bad_input(fmt::format("`peel`: '{}' {}; write THRESHOLD[:LAYERS], like 0.95:4", word, problem));
}

Peel parse_peel(const std::string& word) {
  const std::size_t colon = word.find(':');
  Peel peel;
  const std::optional<double> threshold = number_of<double>(word.substr(0, colon));
  if (!threshold || !(*threshold > 0 && *threshold < 1))
    refuse_peel(word, "has no threshold (an opacity above 0 and below 1)");
  peel.threshold = *threshold;
  if (colon == std::string::npos) return peel;
  const std::optional<double> layers = number_of<double>(word.substr(colon + 1));
  if (!layers || *layers != std::floor(*layers) || !(*layers >= 1 && *layers <= most_layers))
    refuse_peel(word, fmt::format("has no number of layers, 1 to {}", most_layers));
  peel.layers = static_cast<int>(*layers);
  return peel;
}

/// Sets the layers. Outputs and method must already be set.
void set_peel(const OptionWords& words, RenderOptions& options) {
  options.frame.peel = parse_peel(words.word("peel"));
  if (!options.films.empty())
    throw bad_input(fmt::format(
        "`peel`: {} cannot contain layers; give names of images, such as -o a_%04d.png, or leave `peel` out",
        options.films.front().string()));
  if (options.to_standard_output)
    throw bad_input("`peel`: standard output can receive only one image; give a file with -o, or leave `peel` out");
  if (options.show_balance) throw bad_input("`peel`: `show` balance does not draw layers; leave one of the two out");
  if (words.given("deep-accuracy"))
    throw bad_input("`deep_accuracy`: has no effect on the layers of `peel`; leave one of the two out");
  const IntegratorKind kind = options.settings.integrator.kind;
  if (kind != IntegratorKind::automatic && kind != IntegratorKind::exact)
    throw bad_input(
        fmt::format("`peel`: with `integrator` {}, cutting a ray segment changes its colour; use auto or exact",
                    method_word(kind)));
}

/// Throws if the options do not allow deep images of volumes.
void refuse_deep_volumes(const RenderOptions& options) {
  if (options.show_balance)
    throw bad_input("deep image: `show` balance does not draw deep images; give an .exr, .png or .pfm");
  if (options.frame.peel) return;
  if (takes_steps(options.settings.integrator))
    throw bad_input(
        fmt::format("deep image: with `integrator` {}, cutting a step changes its colour; use auto or exact",
                    method_word(options.settings.integrator.kind)));
  if (options.settings.grid.shading) throw bad_input("deep image: shading is not supported; leave `shade` out");
}

/// Throws if none of the images can be annotated.
void refuse_unannotated(const RenderOptions& options) {
  if (options.show_balance) throw bad_input("`show` balance: annotation is not supported; leave one of the two out");
  if (options.annotation.layer.empty() && options.films.empty() && !options.to_standard_output &&
      !options.plan.outputs.empty() && std::ranges::all_of(options.plan.outputs, is_deep_name))
    throw bad_input(
        "deep image: annotation is not supported; also give an .exr, .png or .pfm, or an `annotation_layer`");
}

}  // namespace

ImageFileOptions image_options(const OptionWords& words) {
  ImageFileOptions image;
  image.half = words.given("half");
  assign(image.png_bits, words.choice("png-bits", png_depths));
  image.encode_srgb = !words.choice("blend", off_on).value_or(false);
  assign(image.threads, words.count("threads", 1, 1024));
  image.background = words.color("background");
  return image;
}

void set_outputs(const OptionWords& words, RenderOptions& options) {
  for (const std::string& output : words.words("output")) {
    if (output == standard_stream) {
      if (options.to_standard_output) throw bad_input("-o: '-' is given twice; give it once");
      options.to_standard_output = true;
    } else if (is_film_name(output)) {
      options.films.emplace_back(output);
    } else {
      options.plan.outputs.emplace_back(output);
    }
  }
  options.report = words.word("report");
  options.timing = words.word("timing");
  options.saved_scene = words.word("save-config");
  options.report_to_standard_output = options.report == standard_stream;
  if (options.report_to_standard_output && options.to_standard_output)
    throw bad_input("`report` -: the image is also written to standard output; write one of them to a file");
  options.plan.resume = words.given("resume");
  if (options.plan.resume && options.to_standard_output)
    throw bad_input("`resume`: standard output has no earlier images; leave `resume` out, or write numbered images");
  if (options.plan.resume && !options.films.empty())
    throw bad_input(
        fmt::format("`resume`: {} is always written as a whole; leave `resume` out, or write numbered images",
                    options.films.front().string()));
  if (words.given("frame-rate") && options.films.empty())
    throw bad_input("`frame_rate`: it is for films; give one with -o FILE.mp4, or leave it out");
  assign(options.frame_rate, words.positive("frame-rate"));
  if (options.frame_rate > most_film_rate)
    throw bad_input(fmt::format("`frame_rate`: {} is above {}; give fewer frames per second", words.word("frame-rate"),
                                most_film_rate));
  if (options.frame_rate < least_film_rate)
    throw bad_input(fmt::format("`frame_rate`: {} is below {}; give more frames per second", words.word("frame-rate"),
                                least_film_rate));
  options.quiet = words.given("quiet");
  options.progress = !options.quiet && words.given("progress");
}

void set_pictures(const OptionWords& words, RenderOptions& options) {
  options.frame.deep = std::ranges::any_of(options.plan.outputs, is_deep_name);
  if (!options.frame.deep && !words.given("peel") && words.given("deep-accuracy"))
    throw bad_input("`deep_accuracy`: it is for a deep image; give one with -o FILE.deep.exr, or leave it out");
  assign(options.frame.deep_accuracy, words.positive("deep-accuracy"));
  if (words.given("peel")) set_peel(words, options);
  if (options.is_grid() && options.frame.deep) refuse_deep_volumes(options);
  options.image = image_options(words);
  options.annotation = annotation_options(words, options.image);
  if (options.annotation.annotation) refuse_unannotated(options);
  assign(options.repeat, words.count("repeat", 1));
  if (options.repeat > 0) options.settings.ranks.frames_in_flight = 1;  // measured times are those of a single frame
  assign(options.verify, words.count("verify", 1));
  options.frame.keep_uncertainty = options.is_grid() && options.verify > 0;
}

}  // namespace tessera::api
