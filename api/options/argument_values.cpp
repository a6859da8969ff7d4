// SPDX-License-Identifier: BSD-3-Clause
#include "api/options/argument_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "api/options/choices.hpp"
#include "api/options/color_names.hpp"
#include "tessera/error.hpp"
#include "tessera/program/nearest_name.hpp"
#include "tessera/program/options.hpp"
#include "tessera/program/text.hpp"

namespace tessera {
namespace api {
namespace {

Error wrong(const std::string& option, const std::string& text, const std::string& allowed) {
  return bad_input(fmt::format("{}: '{}' is not {}", option, text, allowed));
}

/// Converts a colour 0xrrggbb in sRGB to linear light (IEC 61966-2-1).
glm::dvec3 linear_color(std::uint32_t rgb) {
  glm::dvec3 color{};
  for (int c = 0; c < 3; ++c) {
    const double display = (rgb >> (16 - 8 * c) & 0xff) / 255.0;
    color[c] = static_cast<float>(display <= 0.04045 ? display / 12.92 : std::pow((display + 0.055) / 1.055, 2.4));
  }
  return color;
}

/// Reads `#rrggbb` or its short form `#rgb`.
std::optional<glm::dvec3> color_of_hex(std::string_view text) {
  const std::string_view digits = text.substr(1);
  const bool is_short = digits.size() == 3;
  if ((!is_short && digits.size() != 6) || digits.find_first_not_of("0123456789abcdefABCDEF") != std::string_view::npos)
    return std::nullopt;
  std::uint32_t rgb = 0;
  for (const char digit : digits) {
    const auto value = static_cast<std::uint32_t>(hex_digit(digit));
    rgb = is_short ? rgb << 8 | 0x11 * value : rgb << 4 | value;
  }
  return linear_color(rgb);
}

}  // namespace

ImageSize parse_size(const std::string& option, const std::string& text) {
  const auto cross = text.find('x');
  const auto allowed = fmt::format("a size; write WxH, each side 1 to {} pixels, like 1024x768", max_image_side);
  if (cross == std::string::npos) throw wrong(option, text, allowed);
  const auto width = number_of<int>(std::string_view(text).substr(0, cross));
  const auto height = number_of<int>(std::string_view(text).substr(cross + 1));
  for (const auto& side : {width, height})
    if (!side || *side < 1 || *side > max_image_side) throw wrong(option, text, allowed);
  return {*width, *height};
}

std::uint64_t parse_bytes(const std::string& option, const std::string& text) {
  constexpr auto allowed = "an amount of memory; write 1M or more, like 512M or 2G";
  std::string_view rest = text;
  for (const std::string_view ending : {"iB", "B"})
    if (rest.ends_with(ending)) {
      rest.remove_suffix(ending.size());
      break;
    }
  double factor = 1;
  constexpr std::string_view suffixes = "KMGT";
  if (!rest.empty())
    if (const auto power = suffixes.find(rest.back()); power != std::string_view::npos) {
      factor = std::exp2(10.0 * static_cast<double>(power + 1));
      rest.remove_suffix(1);
    }
  const auto count = number_of<double>(rest);
  if (!count) throw wrong(option, text, allowed);
  const double bytes = *count * factor;
  if (!(bytes >= std::exp2(20)) || !(bytes < std::exp2(62))) throw wrong(option, text, allowed);
  return static_cast<std::uint64_t>(bytes);
}

std::size_t parse_choice(const std::string& option, std::string_view text, std::span<const std::string_view> known) {
  const auto found = std::ranges::find(known, text);
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  std::string words(known.front());
  for (std::size_t i = 1; i < known.size(); ++i)
    words += fmt::format("{}{}", i + 1 < known.size() ? ", " : " or ", known[i]);
  throw bad_input(fmt::format("{}: '{}' is unknown; use {}", option, text, words));
}

Integrator parse_integrator(const std::string& option, const std::string& text) {
  constexpr std::string_view prefix = "sampled:", table_prefix = "preintegrated:";
  Integrator integrator;
  if (text == "exact") {
    integrator.kind = IntegratorKind::exact;
  } else if (text == "auto") {
    integrator.kind = IntegratorKind::automatic;
  } else if (std::string_view(text).starts_with(prefix)) {
    const auto samples = number_of<int>(std::string_view(text).substr(prefix.size()));
    if (!samples || *samples < 1 || *samples > 4096)
      throw wrong(option, text, "sampled:N with N from 1 to 4096, like sampled:8");
    integrator.kind = IntegratorKind::sampled;
    integrator.samples = *samples;
  } else if (text == "partial") {
    integrator.kind = IntegratorKind::partial;
  } else if (text == "preintegrated" || std::string_view(text).starts_with(table_prefix)) {
    integrator.kind = IntegratorKind::preintegrated;
    if (text != "preintegrated") {
      const auto size = number_of<int>(std::string_view(text).substr(table_prefix.size()));
      if (!size || *size < 8 || *size > 512)
        throw wrong(option, text, "preintegrated:N with N from 8 to 512, like preintegrated:128");
      integrator.table_size = *size;
    }
  } else {
    throw wrong(option, text, "an integrator; use exact, sampled:N, preintegrated[:N], partial or auto");
  }
  return integrator;
}

WithoutWords parse_without(const std::string& option, const std::string& text) {
  WithoutWords without;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string_view word = std::string_view(text).substr(at, end - at);
    const auto* found = std::ranges::find(mechanisms, word, &std::pair<std::string_view, bool Mechanisms::*>::first);
    if ((found == std::end(mechanisms) && word != "merging") || end + 1 == text.size())
      throw wrong(
          option, text,
          "a list of optimizations; write one or more of culling, skipping, termination, lattice, sharing, merging");
    (found == std::end(mechanisms) ? without.merging : without.use.*found->second) = false;
    at = end + 1;
  }
  return without;
}

glm::dvec3 parse_color(const std::string& option, const std::string& text) {
  std::vector<std::string> names;
  for (const NamedColor& color : color_names()) {
    if (text == color.name) return linear_color(color.rgb);
    names.emplace_back(color.name);
  }
  const auto near = nearest_name(text, names);
  const std::string allowed =
      near ? fmt::format("a colour; did you mean {}?", *near)
           : "a colour; write R,G,B (linear light, 0 or more), #rrggbb (sRGB) or a name of CSS, like white, black, "
             "lightgray or steelblue";
  if (text.starts_with('#')) {
    const auto color = color_of_hex(text);
    if (!color) throw wrong(option, text, allowed);
    return *color;
  }

  const std::vector<std::string> channels = split_at_commas(text);
  if (channels.size() != 3) throw wrong(option, text, allowed);
  glm::dvec3 color{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const auto value = number_of<double>(channels[channel]);
    if (!value || !std::isfinite(*value) || *value < 0) throw wrong(option, text, allowed);
    color[static_cast<int>(channel)] = *value;
  }
  return color;
}

double parse_positive(const std::string& option, const std::string& text) {
  const auto value = number_of<double>(text);
  if (!value || !std::isfinite(*value) || !(*value > 0)) throw wrong(option, text, "a number above 0");
  return *value;
}

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t stop = std::min(text.find(',', at), text.size());
    words.push_back(text.substr(at, stop - at));
    at = stop + 1;
  }
  return words;
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count,
                                  const std::string& form) {
  const std::vector<std::string> words = split_at_commas(text);
  if (words.size() != count) throw wrong(option, text, form);
  std::vector<double> values;
  for (const std::string& word : words) {
    const auto value = number_of<double>(word);
    if (!value || !std::isfinite(*value)) throw wrong(option, text, form);
    values.push_back(*value);
  }
  return values;
}

glm::dvec3 parse_vector(const std::string& option, const std::string& text, bool positive) {
  const auto values = parse_numbers(option, text, 3, "three numbers; write X,Y,Z");
  if (positive && !std::ranges::all_of(values, [](double value) { return value > 0; }))
    throw wrong(option, text, "three numbers above 0; write X,Y,Z");
  return {values[0], values[1], values[2]};
}

int parse_count(const std::string& option, const std::string& text, int low, int high) {
  const auto value = number_of<int>(text);
  if (!value || *value < low || *value > high)
    throw wrong(option, text,
                high == std::numeric_limits<int>::max() ? fmt::format("a whole number from {} up", low)
                                                        : fmt::format("a whole number from {} to {}", low, high));
  return *value;
}

}  // namespace api

inline namespace v0_1 {

double parse_number(const std::string& option, const std::string& text) {
  const auto value = number_of<double>(text);
  if (!value || !std::isfinite(*value)) throw api::wrong(option, text, "a number");
  return *value;
}

}  // namespace v0_1
}  // namespace tessera
