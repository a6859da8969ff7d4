#include "apps/argument_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "tessera/error.hpp"

namespace tessera::apps {
namespace {

/// The whole of `text` as a number, or nothing. from_chars knows no locale: "1,5" is never one and a half.
template <class T>
std::optional<T> number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

Error wrong(const std::string& option, const std::string& text, const std::string& allowed) {
  return bad_input(fmt::format("{}: '{}' is not {}", option, text, allowed));
}

/// `#rrggbb` of sRGB in linear light (IEC 61966-2-1).
std::optional<std::array<float, 3>> color_of_hex(std::string_view text) {
  if (text.size() != 7) return std::nullopt;
  std::array<float, 3> color{};
  for (std::size_t c = 0; c < 3; ++c) {
    unsigned byte = 0;
    const char* const first = text.data() + 1 + 2 * c;
    const auto [end, error] = std::from_chars(first, first + 2, byte, 16);
    if (error != std::errc() || end != first + 2) return std::nullopt;
    const double display = byte / 255.0;
    color[c] = static_cast<float>(display <= 0.04045 ? display / 12.92 : std::pow((display + 0.055) / 1.055, 2.4));
  }
  return color;
}

}  // namespace

ImageSize parse_size(const std::string& option, const std::string& text) {
  const auto cross = text.find('x');
  const auto allowed = fmt::format("a size; write WxH, each side 1 to {} pixels, like 1024x768", max_image_side);
  if (cross == std::string::npos) throw wrong(option, text, allowed);
  const auto width = number<int>(std::string_view(text).substr(0, cross));
  const auto height = number<int>(std::string_view(text).substr(cross + 1));
  for (const auto& side : {width, height})
    if (!side || *side < 1 || *side > max_image_side) throw wrong(option, text, allowed);
  return {*width, *height};
}

std::uint64_t parse_bytes(const std::string& option, const std::string& text) {
  constexpr auto allowed = "a size in memory; write 1M or more, like 512M or 2G";
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
  const auto count = number<double>(rest);
  if (!count) throw wrong(option, text, allowed);
  const double bytes = *count * factor;
  if (!(bytes >= std::exp2(20)) || !(bytes < std::exp2(62))) throw wrong(option, text, allowed);
  return static_cast<std::uint64_t>(bytes);
}

Integrator parse_integrator(const std::string& option, const std::string& text, double accuracy) {
  constexpr std::string_view prefix = "sampled:", table_prefix = "preintegrated:";
  Integrator integrator;
  integrator.accuracy = accuracy;
  if (text == "exact") {
    integrator.kind = IntegratorKind::exact;
  } else if (text == "auto") {
    integrator.kind = IntegratorKind::automatic;
  } else if (std::string_view(text).starts_with(prefix)) {
    const auto samples = number<int>(std::string_view(text).substr(prefix.size()));
    if (!samples || *samples < 1 || *samples > 4096)
      throw wrong(option, text, "sampled:N with N from 1 to 4096, like sampled:8");
    integrator.kind = IntegratorKind::sampled;
    integrator.samples = *samples;
  } else if (text == "partial") {
    integrator.kind = IntegratorKind::partial;
  } else if (text == "preintegrated" || std::string_view(text).starts_with(table_prefix)) {
    integrator.kind = IntegratorKind::preintegrated;
    if (text != "preintegrated") {
      const auto size = number<int>(std::string_view(text).substr(table_prefix.size()));
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
  const std::pair<std::string_view, bool*> switches[] = {{"culling", &without.use.culling},
                                                         {"skipping", &without.use.skipping},
                                                         {"termination", &without.use.termination},
                                                         {"lattice", &without.use.lattice},
                                                         {"merging", &without.merging}};
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string_view word = std::string_view(text).substr(at, end - at);
    const auto* found =
        std::find_if(std::begin(switches), std::end(switches), [&](auto& s) { return s.first == word; });
    if (found == std::end(switches) || end + 1 == text.size())
      throw wrong(option, text, "known; write some of culling, skipping, termination, lattice, merging");
    *found->second = false;
    at = end + 1;
  }
  return without;
}

std::array<float, 3> parse_color(const std::string& option, const std::string& text) {
  constexpr auto allowed =
      "a colour; write R,G,B (linear light, 0 or more), #rrggbb (sRGB) or one of black, white, gray, lightgray, "
      "darkgray, red, green, blue, yellow, cyan, magenta, orange, navy";
  constexpr float middle_gray = 0.2158f;  // sRGB 0.5
  constexpr std::pair<std::string_view, std::array<float, 3>> names[] = {
      {"black", {0, 0, 0}},
      {"white", {1, 1, 1}},
      {"gray", {middle_gray, middle_gray, middle_gray}},
      {"grey", {middle_gray, middle_gray, middle_gray}},
      {"red", {1, 0, 0}},
      {"green", {0, 1, 0}},
      {"blue", {0, 0, 1}},
      {"yellow", {1, 1, 0}},
      {"cyan", {0, 1, 1}},
      {"magenta", {1, 0, 1}}};
  for (const auto& [name, color] : names)
    if (text == name) return color;
  constexpr std::pair<std::string_view, std::string_view> hexadecimal[] = {
      {"lightgray", "#d3d3d3"}, {"lightgrey", "#d3d3d3"}, {"darkgray", "#404040"},
      {"darkgrey", "#404040"},  {"orange", "#ffa500"},    {"navy", "#000080"}};
  for (const auto& [name, digits] : hexadecimal)
    if (text == name) return *color_of_hex(digits);
  if (text.starts_with('#')) {
    const auto color = color_of_hex(text);
    if (!color) throw wrong(option, text, allowed);
    return *color;
  }

  std::array<float, 3> color{};
  std::string_view rest = text;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const auto comma = channel < 2 ? rest.find(',') : rest.size();
    if (comma == std::string_view::npos) throw wrong(option, text, allowed);
    const auto value = number<float>(rest.substr(0, comma));
    if (!value || !std::isfinite(*value) || *value < 0) throw wrong(option, text, allowed);
    color[channel] = *value;
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return color;
}

double parse_number(const std::string& option, const std::string& text) {
  const auto value = number<double>(text);
  if (!value || !std::isfinite(*value)) throw wrong(option, text, "a number");
  return *value;
}

double parse_positive(const std::string& option, const std::string& text) {
  const auto value = number<double>(text);
  if (!value || !std::isfinite(*value) || !(*value > 0)) throw wrong(option, text, "a number above 0");
  return *value;
}

glm::dvec3 parse_vector(const std::string& option, const std::string& text, bool positive) {
  glm::dvec3 values;
  std::size_t at = 0;
  for (int k = 0; k < 3; ++k) {
    const std::size_t stop = k < 2 ? text.find(',', at) : text.size();
    if (stop == std::string::npos) throw wrong(option, text, "three numbers; write X,Y,Z");
    const std::string word = text.substr(at, stop - at);
    values[k] = positive ? parse_positive(option, word) : parse_number(option, word);
    at = stop + 1;
  }
  return values;
}

int parse_count(const std::string& option, const std::string& text, int low, int high) {
  const auto value = number<int>(text);
  if (!value || *value < low || *value > high)
    throw wrong(option, text,
                high == std::numeric_limits<int>::max() ? fmt::format("a whole number from {} up", low)
                                                        : fmt::format("a whole number from {} to {}", low, high));
  return *value;
}

}  // namespace tessera::apps
