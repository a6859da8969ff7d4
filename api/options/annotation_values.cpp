// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>
#include <utility>

#include "api/options/choices.hpp"
#include "api/options/setting_name.hpp"
#include "api/options/values.hpp"
#include "tessera/error.hpp"

namespace tessera {
namespace api {
namespace {

std::optional<Place> place_of(std::string_view word) {
  const auto* found = std::ranges::find(places, word, &std::pair<std::string_view, Place>::first);
  return found == std::end(places) ? std::nullopt : std::optional(found->second);
}

/// The place given as the flag's value, or `otherwise` for a flag without a value.
Place parse_place(const char* option, const std::string& word, Place otherwise) {
  if (word == "true") return otherwise;
  if (const auto place = place_of(word)) return *place;
  std::string known;
  for (const auto& [name, place] : places) known += fmt::format("{}{}", known.empty() ? "" : " or ", name);
  throw bad_input(fmt::format("{}: '{}' is not a place; use {}", option, word, known));
}

/// Splits the words into place and text. The part before the first colon is a place only if it is the name of one:
/// "Time: {time}" is a text.
Text parse_text(const std::string& words) {
  const std::size_t colon = words.find(':');
  const auto place = colon == std::string::npos ? std::nullopt : place_of(std::string_view(words).substr(0, colon));
  return place ? Text{words.substr(colon + 1), *place} : Text{words};
}

ColorBar parse_color_bar(const OptionWords& words) {
  ColorBar bar;
  bar.place = parse_place("`color_bar`", words.word("color-bar"), Place::right);
  bar.title = words.given("color-bar-title") ? words.word("color-bar-title") : "{field}";
  if (words.given("field-unit")) bar.title += fmt::format(" [{}]", words.word("field-unit"));
  bar.range = words.interval("color-bar-range");
  const auto scale = words.choice("color-bar-scale", off_on);
  // By default the bar has the scale of the transfer function, if all its values have a logarithm.
  bar.logarithmic = scale.value_or(words.given("log") && (!bar.range || (*bar.range)[0] > 0));
  return bar;
}

Axes parse_axes(const OptionWords& words) {
  if (words.word("axes") == "true") return {};
  const std::size_t shown = *words.choice("axes");  // 0: triad, 1: box, 2: both
  return {.triad = shown != 1, .box = shown != 0};
}

/// Throws if `what` is not drawn, but an option states how to draw it.
void refuse_without(bool drawn, const char* what, const OptionWords& words,
                    std::initializer_list<const char*> options) {
  for (const char* option : options)
    if (!drawn && words.given(option))
      throw bad_input(
          fmt::format("{}: it has no effect without {}; give both, or leave it out", setting_name(option), what));
}

void check_layer(const std::filesystem::path& layer) {
  const std::string extension = layer.extension().string();
  if ((extension != ".png" && extension != ".exr") || is_deep_name(layer))
    throw bad_input(fmt::format("`annotation_layer` {}: this layer needs an alpha channel; give a .png or an .exr",
                                layer.string()));
}

}  // namespace

AnnotationOptions annotation_options(const OptionWords& words, const ImageFileOptions& image) {
  AnnotationOptions options;
  if (std::ranges::none_of(option_rows(Trait::annotation), [&](const auto* row) { return words.given(row->key()); }))
    return options;
  Annotation drawn;
  if (words.given("color-bar")) drawn.color_bar = parse_color_bar(words);
  if (words.given("axes")) drawn.axes = parse_axes(words);
  if (words.given("outline")) drawn.outline = Outline{};
  if (words.given("scale-bar"))
    drawn.scale_bar = ScaleBar{parse_place("`scale_bar`", words.word("scale-bar"), Place::bottom_right)};
  for (const std::string& text : words.words("annotate")) drawn.texts.push_back(parse_text(text));
  refuse_without(drawn.color_bar.has_value(), "`color_bar`", words,
                 {"color-bar-title", "color-bar-range", "color-bar-scale", "field-unit"});
  refuse_without((drawn.axes && drawn.axes->box) || drawn.scale_bar, "`axes`=box or `scale_bar`", words,
                 {"length-unit"});
  refuse_without(drawn.color_bar || drawn.axes || drawn.outline || drawn.scale_bar || !drawn.texts.empty(),
                 "`color_bar`, `axes`, `outline`, `scale_bar` or `annotate`", words,
                 {"annotation-color", "annotation-size", "annotation-layer"});
  AnnotationStyle& style = drawn.style;
  style.ink = words.color("annotation-color");
  style.text_size = words.positive("annotation-size");
  style.length_unit = words.word("length-unit");
  style.background = image.background;
  style.display_colors = !image.encode_srgb;
  options.layer = words.word("annotation-layer");
  if (!options.layer.empty()) check_layer(options.layer);
  options.annotation = std::move(drawn);
  return options;
}

}  // namespace api

inline namespace v0_1 {

AnnotationValues annotation_values(const Dataset& data, double time, const std::string& file, int frame) {
  const auto [low, high] = data.range();
  return {data.field_name(),        fmt::format("{:g}", time),  file,
          fmt::format("{}", frame), fmt::format("{:.6g}", low), fmt::format("{:.6g}", high)};
}

Annotation filled_annotation(const Annotation& annotation, const AnnotationValues& values) {
  const std::array<AnnotationWord, 6> words = {{{"field", values.field},
                                                {"time", values.time},
                                                {"file", values.file},
                                                {"frame", values.frame},
                                                {"min", values.min},
                                                {"max", values.max}}};
  Annotation result = annotation;
  for (Text& text : result.texts) text.text = fill_in(text.text, words);
  if (result.color_bar) result.color_bar->title = fill_in(result.color_bar->title, words);
  return result;
}

}  // namespace v0_1
}  // namespace tessera
