// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/annotation_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <variant>

#include "apps/options/argument_values.hpp"
#include "apps/options/compositing_options.hpp"
#include "apps/options/setting_words.hpp"
#include "tessera/error.hpp"

namespace tessera::apps {
namespace {

/// An option that takes a value, one that may, `--option=value`, or one that may be repeated.
enum class Form { value, flag, list };

struct Declared {
  const char *option, *type, *help;
  Form form;
  std::variant<std::string AnnotationWords::*, std::vector<std::string> AnnotationWords::*> words;
};

using W = AnnotationWords;

// From here follow command line, help and report.
constexpr std::array declared{
    Declared{"--color-bar", "", "draw the transfer function's colours and opacity; =left, =top or =bottom: there",
             Form::flag, &W::color_bar},
    Declared{"--color-bar-title", "TEXT", "over the colour bar (default: {field})", Form::value, &W::title},
    Declared{"--color-bar-range", "LOW,HIGH", "values at its ends (default: the transfer function's)", Form::value,
             &W::range},
    Declared{"--color-bar-scale", "linear|log", "how values lie along it (default: log with --log)", Form::value,
             &W::scale},
    Declared{"--field-unit", "TEXT", "of the field's values, in the colour bar's title", Form::value, &W::unit},
    Declared{"--axes", "", "draw the axes' directions; =box: round values along the data's box; =both", Form::flag,
             &W::axes},
    Declared{"--outline", "", "draw the box of the data", Form::flag, &W::outline},
    Declared{"--scale-bar", "", "draw a bar of a round length; =bottom, =bottom-left ...: there", Form::flag,
             &W::scale_bar},
    Declared{"--length-unit", "TEXT", "of the world, at axes and scale bar", Form::value, &W::length_unit},
    Declared{"--annotate", "[PLACE:]TEXT",
             "write this at top-left (default), top, ... bottom-right; {field} {time} {file} {frame} {min} {max} are "
             "filled in; may be repeated",
             Form::list, &W::texts},
    Declared{"--annotation-color", "R,G,B|NAME", "of text and lines (default: what the background leaves readable)",
             Form::value, &W::color},
    Declared{"--annotation-size", "PIXELS", "height of text (default: 2 % of the picture's)", Form::value, &W::size},
    Declared{"--annotation-layer", "FILE", ".png or .exr: the annotation alone, with alpha; pictures stay bare",
             Form::value, &W::layer}};

constexpr std::array<std::pair<std::string_view, Place>, 8> places{{{"top-left", Place::top_left},
                                                                    {"top", Place::top},
                                                                    {"top-right", Place::top_right},
                                                                    {"left", Place::left},
                                                                    {"right", Place::right},
                                                                    {"bottom-left", Place::bottom_left},
                                                                    {"bottom", Place::bottom},
                                                                    {"bottom-right", Place::bottom_right}}};

std::optional<Place> place_of(std::string_view word) {
  const auto* found = std::ranges::find(places, word, &std::pair<std::string_view, Place>::first);
  return found == places.end() ? std::nullopt : std::optional(found->second);
}

/// A flag's place, or `otherwise` for the bare flag.
Place parse_place(const char* option, const std::string& word, Place otherwise) {
  if (word == "true") return otherwise;
  if (const auto place = place_of(word)) return *place;
  std::string known;
  for (const auto& [name, place] : places) known += fmt::format("{}{}", known.empty() ? "" : " or ", name);
  throw bad_input(fmt::format("{}: '{}' is no place; use {}", option, word, known));
}

std::array<double, 2> parse_range(const std::string& option, const std::string& words) {
  const auto ends = parse_numbers(option, words, 2, "LOW,HIGH, two numbers");
  if (!(ends[0] < ends[1]))
    throw bad_input(fmt::format("{}: '{}' does not ascend; give the lower one first", option, words));
  return {ends[0], ends[1]};
}

/// Only a known place before the first colon is one: "Time: {time}" is text.
Text parse_text(const std::string& words) {
  const std::size_t colon = words.find(':');
  const auto place = colon == std::string::npos ? std::nullopt : place_of(std::string_view(words).substr(0, colon));
  return place ? Text{words.substr(colon + 1), *place} : Text{words};
}

ColorBar parse_color_bar(const W& words) {
  ColorBar bar;
  bar.place = parse_place("--color-bar", words.color_bar, Place::right);
  bar.title = words.title.empty() ? "{field}" : words.title;
  if (!words.unit.empty()) bar.title += fmt::format(" [{}]", words.unit);
  if (!words.scale.empty()) check_word("--color-bar-scale", words.scale, {"linear", "log"});
  bar.logarithmic = words.scale == "log";
  if (!words.range.empty()) bar.range = parse_range("--color-bar-range", words.range);
  return bar;
}

Axes parse_axes(const std::string& words) {
  if (words != "true") check_word("--axes", words, {"triad", "box", "both"});
  return {.triad = words != "box", .box = words == "box" || words == "both"};
}

/// Options that say how to draw `what`, if it is not drawn.
void refuse_without(bool drawn, const char* what, std::initializer_list<std::pair<const char*, bool>> given) {
  for (const auto& [option, is_given] : given)
    if (is_given && !drawn)
      throw bad_input(fmt::format("{}: has no effect without {}; give that too, or leave it out", option, what));
}

void check_layer(const std::filesystem::path& layer) {
  const std::string extension = layer.extension().string();
  if ((extension != ".png" && extension != ".exr") || is_deep_name(layer))
    throw bad_input(fmt::format("--annotation-layer {}: it has alpha; name a .png or an .exr", layer.string()));
}

}  // namespace

void add_annotation_options(CLI::App& command, AnnotationWords& words) {
  for (const Declared& d : declared) {
    if (d.form == Form::list)
      command.add_option(d.option, words.*std::get<std::vector<std::string> W::*>(d.words), d.help)
          ->type_name(d.type)
          ->allow_extra_args(false);
    else if (d.form == Form::flag)
      command.add_flag(d.option, words.*std::get<std::string W::*>(d.words), d.help);
    else
      command.add_option(d.option, words.*std::get<std::string W::*>(d.words), d.help)->type_name(d.type);
  }
}

AnnotationOptions annotation_options(const AnnotationWords& words, const ImageFileOptions& image) {
  AnnotationOptions options;
  for (const Declared& d : declared) {
    if (const auto* list = std::get_if<std::vector<std::string> W::*>(&d.words)) {
      if (!(words.**list).empty()) options.given[d.option + 2] = words.**list;
    } else if (const std::string& word = words.*std::get<std::string W::*>(d.words); !word.empty()) {
      options.given[d.option + 2] = word;
    }
  }
  if (options.given.empty()) return options;

  Annotation drawn;
  if (!words.color_bar.empty()) drawn.color_bar = parse_color_bar(words);
  if (!words.axes.empty()) drawn.axes = parse_axes(words.axes);
  if (!words.outline.empty()) {
    if (words.outline != "true") throw bad_input("--outline: takes no value; leave that out");
    drawn.outline = Outline{};
  }
  if (!words.scale_bar.empty())
    drawn.scale_bar = ScaleBar{parse_place("--scale-bar", words.scale_bar, Place::bottom_right)};
  for (const std::string& text : words.texts) drawn.texts.push_back(parse_text(text));
  refuse_without(drawn.color_bar.has_value(), "--color-bar",
                 {{"--color-bar-title", !words.title.empty()},
                  {"--color-bar-range", !words.range.empty()},
                  {"--color-bar-scale", !words.scale.empty()},
                  {"--field-unit", !words.unit.empty()}});
  refuse_without((drawn.axes && drawn.axes->box) || drawn.scale_bar, "--axes=box or --scale-bar",
                 {{"--length-unit", !words.length_unit.empty()}});
  refuse_without(drawn.color_bar || drawn.axes || drawn.outline || drawn.scale_bar || !drawn.texts.empty(),
                 "--color-bar, --axes, --outline, --scale-bar or --annotate",
                 {{"--annotation-color", !words.color.empty()},
                  {"--annotation-size", !words.size.empty()},
                  {"--annotation-layer", !words.layer.empty()}});
  AnnotationStyle& style = drawn.style;
  if (!words.color.empty()) {
    const auto color = parse_color("--annotation-color", words.color);
    style.ink = glm::dvec3(color[0], color[1], color[2]);
  }
  if (!words.size.empty()) style.text_size = parse_positive("--annotation-size", words.size);
  style.length_unit = words.length_unit;
  style.background = image.background;
  style.display_colors = !image.encode_srgb;
  if (!words.layer.empty()) check_layer(words.layer);
  options.layer = words.layer;
  options.annotation = std::move(drawn);
  return options;
}

}  // namespace tessera::apps
