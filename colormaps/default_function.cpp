// SPDX-License-Identifier: BSD-3-Clause
#include "colormaps/default_function.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "colormaps/color_map_tables.hpp"
#include "colormaps/pilot_pixels.hpp"
#include "colormaps/presets.hpp"
#include "colormaps/transfer_curves.hpp"
#include "scene/error.hpp"

namespace tessera::colormaps {
namespace {

constexpr int bands = 24;
constexpr std::size_t most_labels = 24;
constexpr double highest_label = 63;

bool whole(double x) { return x == std::floor(x) && std::abs(x) < 1e9; }

/// Colour and opacity, before scaling, at a value in Hounsfield units.
struct CtPoint {
  double value;
  glm::dvec3 color;
  double opacity;
};
constexpr std::array<CtPoint, 10> ct_points{{{-900, {0.55, 0.65, 0.75}, 0},
                                             {-700, {0.55, 0.65, 0.75}, 0.002},
                                             {-400, {0.70, 0.55, 0.45}, 0.002},
                                             {-150, {0.90, 0.70, 0.50}, 0.02},
                                             {-50, {0.90, 0.65, 0.45}, 0.03},
                                             {20, {0.75, 0.32, 0.25}, 0.06},
                                             {120, {0.80, 0.40, 0.30}, 0.10},
                                             {250, {0.95, 0.85, 0.70}, 0.30},
                                             {600, {0.98, 0.93, 0.82}, 0.60},
                                             {1500, {1.00, 0.98, 0.94}, 0.80}}};

constexpr std::array<glm::dvec3, 4> body_colors{
    {{0.35, 0.08, 0.06}, {0.72, 0.30, 0.20}, {0.93, 0.68, 0.48}, {1.0, 0.96, 0.86}}};
/// Colours from far to near.
constexpr std::array<glm::dvec3, 4> shape_colors{
    {{0.10, 0.14, 0.30}, {0.22, 0.42, 0.58}, {0.62, 0.72, 0.66}, {0.98, 0.95, 0.85}}};

std::vector<ColorPoint> spread(std::span<const glm::dvec3> colors, double low, double high) {
  std::vector<ColorPoint> points;
  for (std::size_t i = 0; i < colors.size(); ++i)
    points.push_back(
        {std::lerp(low, high, static_cast<double>(i) / static_cast<double>(colors.size() - 1)), colors[i]});
  return points;
}

/// Hues of consecutive labels differ by a golden angle, so that neighbours differ most, and any 24 are distinct.
glm::dvec3 label_color(double label) {
  const double turns = 0.58 + 0.6180339887498949 * std::abs(label);
  const double hue = turns - std::floor(turns);
  const double value = std::fmod(std::abs(label), 2) == 0 ? 0.95 : 0.80;
  glm::dvec3 color;
  for (int c = 0; c < 3; ++c) {
    const double x = std::fmod(hue * 6 + std::array{0.0, 4.0, 2.0}[static_cast<std::size_t>(c)], 6.0);
    color[c] = value * (1 - 0.7 * (1 - std::clamp(std::abs(x - 3) - 1, 0.0, 1.0)));
  }
  return color;
}

/// Curves with unscaled opacities; these are given as extinctions in units of 1 / unit distance.
struct Draft {
  std::vector<ColorPoint> colors;
  std::vector<std::array<double, 2>> extinctions;  ///< value, extinction
  ColorSpace space = ColorSpace::rgb;
  double mean_alpha = 0.4;
  std::string name;
  std::array<double, 2> range{};
  bool scales = true;
};

/// For known labels, the steps are halfway to the next label, but at most half a unit from the label, and opacity is
/// zero between labels.
Draft draft_known_labels(const std::vector<double>& labels, const std::array<double, 2>& range,
                         const ValueShares& shares) {
  Draft draft;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const bool is_first = i == 0, is_last = i + 1 == labels.size();
    const double low = is_first ? labels[i] : std::max(labels[i] - 0.5, (labels[i - 1] + labels[i]) / 2);
    const double high = is_last ? labels[i] : std::min(labels[i] + 0.5, (labels[i] + labels[i + 1]) / 2);
    const double share = std::max(shares.between(low, is_last ? high + 1 : high), 1e-3);
    const double extinction = labels[i] == 0 ? 0 : std::pow(share, -0.6);
    const bool follows_gap = !is_first && labels[i] - labels[i - 1] > 1,
               precedes_gap = !is_last && labels[i + 1] - labels[i] > 1;
    if (follows_gap) draft.extinctions.push_back({low, 0});
    for (const double end : {low, high}) {
      draft.colors.push_back({end, label_color(labels[i])});
      draft.extinctions.push_back({end, extinction});
    }
    if (precedes_gap) draft.extinctions.push_back({high, 0});
  }
  draft.range = range;
  draft.name = fmt::format("{} labels {:g} to {:g}", labels.size(), range[0], range[1]);
  return draft;
}

Draft draft_labels(const DefaultField& field, const std::array<double, 2>& range, const ValueShares& shares) {
  if (field.labels) return draft_known_labels(*field.labels, range, shares);
  Draft draft;
  std::vector<double> labels = shares.distinct(most_labels);
  if (range[0] >= 0 && range[1] <= highest_label) {
    labels.resize(static_cast<std::size_t>(range[1] - range[0]) + 1);
    std::iota(labels.begin(), labels.end(), range[0]);
  }
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const bool clear = field.is_grid && labels[i] == 0;
    const double low = i == 0 ? labels[i] : (labels[i - 1] + labels[i]) / 2;
    const double high = i + 1 == labels.size() ? labels[i] : (labels[i] + labels[i + 1]) / 2;
    // Opacity is proportional to the inverse of the label's share of the volume, damped, so that small organs stay
    // visible inside large ones.
    const double share = std::max(shares.between(low, high + (i + 1 == labels.size() ? 1 : 0)), 1e-3);
    const double extinction = clear ? 0 : std::pow(share, -0.6);
    for (const double end : {low, high}) {
      draft.colors.push_back({end, label_color(labels[i])});
      draft.extinctions.push_back({end, extinction});
    }
  }
  draft.range = range;
  draft.name = fmt::format("labels {:g} to {:g}", range[0], range[1]);
  return draft;
}

Draft draft_ct() {
  Draft draft;
  for (const CtPoint& point : ct_points) {
    draft.colors.push_back({point.value, point.color});
    draft.extinctions.push_back({point.value, -std::log1p(-point.opacity)});
  }
  draft.range = {ct_points.front().value, ct_points.back().value};
  draft.name = "CT (Hounsfield units; air, below -900, is transparent)";
  return draft;
}

/// Returns extinctions for which every band of the range absorbs about the same.
std::vector<std::array<double, 2>> even_extinctions(const ValueShares& shares, const DefaultRange& r) {
  std::array<double, bands> share{}, smooth{};
  const double from = r.has_ground ? r.ground : r.low, width = (r.high - from) / bands;
  double sum = 0;
  for (int b = 0; b < bands; ++b) {
    const double low = b == 0 ? (r.has_ground ? from : -1e300) : from + b * width;
    share[static_cast<std::size_t>(b)] = shares.between(low, b == bands - 1 ? 1e300 : from + (b + 1) * width);
    sum += share[static_cast<std::size_t>(b)];
  }
  for (int b = 0; b < bands; ++b) {
    const auto at = [&](int i) { return share[static_cast<std::size_t>(std::clamp(i, 0, bands - 1))]; };
    smooth[static_cast<std::size_t>(b)] = (at(b - 1) + 2 * at(b) + at(b + 1)) / 4 / std::max(sum, 1e-300);
  }
  std::vector<std::array<double, 2>> points;
  points.reserve(bands + 2);
  if (r.has_ground) {
    points.push_back({std::min(r.low, r.ground), 0});
    points.push_back({r.ground, 0});
  }
  for (int b = 0; b < bands; ++b) {
    const double t = (b + 0.5) / bands, value = from + (b + 0.5) * width;
    const double rise = r.about_zero ? 1 + 2 * std::abs(2 * t - 1) : 1 + 2 * t;
    // No band is treated as rarer than a fifth of an even share, because rare values must not hide everything else.
    points.push_back({value, rise * std::pow(std::max(smooth[static_cast<std::size_t>(b)], 0.2 / bands), -0.8)});
  }
  return points;
}

Draft draft_values(const DefaultField& field, const std::array<double, 2>& range, const ValueShares& shares, bool body,
                   const TransferFunctionOptions& options) {
  Draft draft;
  DefaultRange r = default_range(field, shares, range);
  if (options.range) r.low = (*options.range)[0], r.high = (*options.range)[1];
  if (options.range) r.has_ground = r.has_ground && r.ground > r.low && r.ground < r.high;
  draft.extinctions = even_extinctions(shares, r);
  draft.range = {r.low, r.high};
  const std::string how = options.range ? "`range`" : "0.5 to 99.5 % of the volume";
  if (body) {
    draft.colors = spread(body_colors, r.has_ground ? r.ground : r.low, r.high);
    draft.space = ColorSpace::lab;
    draft.name = fmt::format("body over {:.6g} to {:.6g}, {}", r.low, r.high, how);
  } else {
    const ColorMapTable& table = color_map_tables().front();
    draft.colors = spread(table.colors, r.low, r.high);
    draft.space = table.space;
    draft.name = fmt::format("{} over {:.6g} to {:.6g}, {}", table.name, r.low, r.high, how);
  }
  if (r.has_ground)
    draft.name +=
        fmt::format(", transparent in the {:.0f} % of the volume below {:.4g}", 100 * r.ground_share, r.ground);
  return draft;
}

Draft draft_shape(const ValueShares& shares, const std::array<double, 2>& range) {
  Draft draft;
  const double low = shares.empty() ? range[0] : shares.quantile(0.005);
  const double high = shares.empty() ? range[1] : shares.quantile(0.995);
  draft.range = low < high ? std::array{low, high} : range;
  draft.colors = spread(shape_colors, draft.range[0], draft.range[1]);
  draft.space = ColorSpace::lab;
  draft.extinctions = {{draft.range[0], 1.2}, {draft.range[1], 1.2}};  // depth 12 over the mean thickness: almost solid
  draft.scales = false;
  draft.name = "shape by depth";
  return draft;
}

/// Converts extinctions to opacities. Extinctions are clamped to 8 per unit distance, which transmits 3e-4.
std::vector<OpacityPoint> opacities_of(const Draft& draft, double scale) {
  std::vector<OpacityPoint> points;
  for (const auto& [value, extinction] : draft.extinctions)
    points.push_back({value, -std::expm1(-std::min(extinction * scale, 8.0))});
  return points;
}

}  // namespace

ValueShares::ValueShares(const scene::FieldSamples& samples, bool stored) {
  std::vector<std::pair<double, double>> sorted;
  sorted.reserve(samples.samples.size());
  const bool own = stored && samples.stored.size() == samples.samples.size();
  for (std::size_t i = 0; i < samples.samples.size(); ++i)
    sorted.emplace_back(own ? samples.stored[i] : samples.samples[i].value, samples.samples[i].volume);
  std::ranges::sort(sorted);  // also sorted by volume, so that sums have the same bits for any order of samples
  double sum = 0;
  for (const auto& [value, volume] : sorted) {
    values_.push_back(value);
    sums_.push_back(sum);
    sum += volume;
  }
  sums_.push_back(sum);
  for (double& s : sums_) s /= std::max(sum, 1e-300);
}

double ValueShares::below(double value) const {
  return sums_[static_cast<std::size_t>(std::ranges::lower_bound(values_, value) - values_.begin())];
}

double ValueShares::between(double low, double high) const { return below(high) - below(low); }

double ValueShares::quantile(double share, double from) const {
  if (values_.empty()) return 0;
  const double before = below(from), sought = before + share * (1 - before);
  const auto after = std::ranges::upper_bound(sums_, sought);
  const auto at = std::max<std::ptrdiff_t>(after - sums_.begin() - 1, 0);
  return values_[std::min(static_cast<std::size_t>(at), values_.size() - 1)];
}

std::vector<double> ValueShares::distinct(std::size_t most) const {
  std::vector<double> found;
  for (const double value : values_)
    if (found.empty() || found.back() != value) {
      if (found.size() == most) return {};
      found.push_back(value);
    }
  return found;
}

DefaultKind default_kind(const DefaultField& field, const std::array<double, 2>& range) {
  if (range[0] == range[1]) return DefaultKind::constant;
  if (field.shape) return DefaultKind::shape;
  if (field.labels && !field.labels->empty()) return DefaultKind::labels;
  const bool patient = field.axes != BodyAxes::none;
  if ((field.modality.empty() ? patient : field.modality == "CT") && range[0] <= -900 && range[1] >= 200)
    return DefaultKind::ct;
  if (!field.labels && whole(range[0]) && whole(range[1]) && !field.samples->samples.empty()) {
    const ValueShares shares(*field.samples, true);
    const std::vector<double> labels = shares.distinct(highest_label + 1);
    const bool few = labels.size() <= most_labels || (range[0] >= 0 && range[1] <= highest_label);
    if (labels.size() > 2 && few && std::ranges::all_of(labels, whole)) return DefaultKind::labels;
  }
  return patient && field.is_grid ? DefaultKind::body : DefaultKind::values;
}

DefaultRange default_range(const DefaultField& field, const ValueShares& shares, const std::array<double, 2>& range) {
  DefaultRange r{range[0], range[1], range[0]};
  if (shares.empty()) return r;
  const double low = shares.quantile(0.001), high = shares.quantile(0.999), width = (high - low) / 32;
  if (field.is_grid && width > 0) {
    int mode = 0;
    double most = 0;
    const auto share = [&](int b) { return shares.between(b == 0 ? -1e300 : low + b * width, low + (b + 1) * width); };
    for (int b = 0; b < 32; ++b)
      if (share(b) > most) most = share(b), mode = b;
    if (most >= 1.0 / 3 && mode < 6) {
      int end = mode + 1;
      while (end < 12 && share(end) > 0.03 && share(end) < share(end - 1)) ++end;
      r.has_ground = true;
      r.ground = low + end * width;
      r.ground_share = shares.between(-1e300, r.ground);
    }
  }
  const double from = r.has_ground ? r.ground : -1e300;
  r.low = shares.quantile(0.005, from);
  r.high = shares.quantile(0.995, from);
  if (!(r.low < r.high)) {
    DefaultRange all{range[0], range[1], range[0]};
    return all;
  }
  // Removes rounding errors: 0 is more readable than 3.57e-18.
  for (double* const end : {&r.low, &r.high})
    if (std::abs(*end) < 1e-6 * (r.high - r.low)) *end = 0;
  if (r.has_ground) r.low = std::min(r.low, r.ground);
  if (!r.has_ground && r.low < 0 && r.high > 0 && std::min(-r.low, r.high) > 0.3 * std::max(-r.low, r.high)) {
    r.about_zero = true;
    r.high = std::max(-r.low, r.high);
    r.low = -r.high;
  }
  return r;
}

LoadedTransferFunction default_function(const DefaultField& field, const TransferFunctionOptions& options) {
  check(options);
  const DefaultKind kind = default_kind(field, options.field_range);
  if (kind == DefaultKind::constant) return default_transfer_function(options);
  const ValueShares shares(*field.samples);
  Draft draft =
      kind == DefaultKind::shape    ? draft_shape(shares, options.field_range)
      : kind == DefaultKind::labels ? draft_labels(field, options.field_range, ValueShares(*field.samples, true))
      : kind == DefaultKind::ct     ? draft_ct()
                                : draft_values(field, options.field_range, shares, kind == DefaultKind::body, options);
  TransferCurves curves{std::move(draft.colors), {}, draft.space};
  if (!options.opacity_points.empty()) {
    curves.opacities = points_over(options.opacity_points, draft.range[0], draft.range[1]);
    draft.name += ", opacities `opacity_points`";
  } else {
    const double unit = options.default_unit_distance;
    const PilotPixels pixels(*field.samples, draft.extinctions, 1 / unit);
    curves.opacities = opacities_of(draft, draft.scales ? pixels.scale(draft.mean_alpha) : 1);
  }
  const double distance = options.unit_distance.value_or(options.default_unit_distance);
  LoadedTransferFunction loaded{make_transfer_function(refined_knots(curves, {.unit_distance = distance,
                                                                              .opacity_scale = options.opacity_scale,
                                                                              .display_colors = options.display_colors,
                                                                              .color_tolerance = 5e-4,
                                                                              .extinction_tolerance = 5e-3}),
                                                       "default"),
                                draft.name + " (default)", distance,
                                options.unit_distance ? "`unit_distance`" : "default"};
  loaded.range = draft.range;
  loaded.shaded = kind == DefaultKind::ct || kind == DefaultKind::body;
  return loaded;
}

}  // namespace tessera::colormaps
