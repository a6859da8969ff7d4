// SPDX-License-Identifier: BSD-3-Clause
#include "api/transfer_function_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "api/dataset.hpp"
#include "colormaps/default_function.hpp"
#include "frame/mesh/mesh_input.hpp"
#include "io/scene/transfer_function_file.hpp"
#include "scene/error.hpp"

namespace tessera::api {
namespace {

/// Distance of knots, in powers of ten, for functions of the base-10 logarithm. Between such knots the function is
/// linear in the value; the error is below 2e-4 of the change of a colour or extinction.
constexpr double decades_a_knot = 1.0 / 64;

LoadedTransferFunction load(const std::string& file_or_preset, const colormaps::DefaultField& field,
                            const colormaps::TransferFunctionOptions& options) {
  return file_or_preset.empty() ? colormaps::default_function(field, options)
                                : io::load_transfer_function(file_or_preset, options);
}

colormaps::TransferFunctionOptions loading_options(const Dataset::State& data, const TransferFunctionOptions& options) {
  colormaps::TransferFunctionOptions loading;
  loading.field_range = data.facts_of_all().scalar_range;
  loading.unit_distance = options.unit_distance;
  loading.default_unit_distance = frame::default_unit_distance(data.facts_of_all());
  loading.display_colors = options.display_colors;
  loading.rescale = options.rescale;
  loading.opacity_scale = options.opacity_scale;
  loading.range = options.range;
  loading.opacity_points = options.opacity_points;
  loading.rescale_presets = options.rescale_presets;
  return loading;
}

/// Converts a function of log10 of the value to a function of the value.
TransferFunction over_values(const TransferFunction& logarithmic) {
  std::vector<Knot> knots;
  const auto add = [&](Knot knot, double exponent) {
    knot.value = std::pow(10.0, exponent);
    if (!knots.empty()) knot.value = std::max(knot.value, knots.back().value);
    knots.push_back(knot);
  };
  const auto of = logarithmic.knots();
  for (std::size_t i = 0; i < of.size(); ++i) {
    add(of[i], of[i].value);
    if (i + 1 == of.size()) break;
    const double span = of[i + 1].value - of[i].value;
    const auto pieces = static_cast<int>(std::clamp(std::ceil(span / decades_a_knot), 1.0, 1e5));
    for (int k = 1; k < pieces; ++k) {
      const double x = of[i].value + span * k / pieces;
      add(logarithmic.evaluate(x), x);
    }
  }
  return TransferFunction(std::move(knots));
}

double smallest_positive(const Dataset::State& data) {
  const auto [low, high] = data.facts_of_all().scalar_range;
  if (!(high > 0))
    throw scene::bad_input(
        fmt::format("{}: `log`: the field {} has no positive value, its largest is {:.6g}; leave `log` out",
                    data.source, data.field_name, high));
  if (low > 0) return low;
  double least = high;
  const scene::FieldSamples& found = data.field_samples();
  const auto consider = [&](double value) {
    if (value > 0) least = std::min(least, value);
  };
  // Interpolated values of a grid may be arbitrarily close to 0 next to a sample <= 0, so the stored samples are used.
  std::ranges::for_each(found.stored, consider);
  if (found.stored.empty())
    for (const scene::FieldSample& s : found.samples) consider(s.value);
  return least;
}

LoadedTransferFunction logarithmic(const Dataset::State& data, const std::string& file_or_preset,
                                   const TransferFunctionOptions& options) {
  colormaps::TransferFunctionOptions loading = loading_options(data, options);
  const double least = smallest_positive(data);
  std::vector<std::string> warnings;
  if (data.facts_of_all().scalar_range[0] <= 0)
    warnings.push_back(fmt::format(
        "values of 0 and below are treated as {:.6g}, the smallest positive value found, for `log`", least));
  std::array<double, 2> span = options.range.value_or(std::array{least, data.facts_of_all().scalar_range[1]});
  if (!(span[1] > 0))
    throw scene::bad_input(fmt::format("`range` ends at {}, but `log` needs a positive value; give one", span[1]));
  span[0] = span[0] > 0 ? span[0] : std::min(least, span[1]);
  const auto exponent = [&](double value) { return std::log10(std::max(value, least)); };
  loading.field_range = {exponent(data.facts_of_all().scalar_range[0]), exponent(data.facts_of_all().scalar_range[1])};
  loading.rescale = true;
  if (options.range || !file_or_preset.empty()) loading.range = {{std::log10(span[0]), std::log10(span[1])}};
  if (loading.range && !((*loading.range)[0] < (*loading.range)[1])) loading.range.reset();
  scene::FieldSamples samples;
  if (file_or_preset.empty()) {
    samples = data.field_samples();
    for (scene::FieldSample& s : samples.samples) s.value = exponent(s.value);
    for (double& value : samples.stored) value = exponent(value);
  }
  LoadedTransferFunction loaded =
      load(file_or_preset, {&samples, data.samples != nullptr, data.shape, BodyAxes::none, {}, {}}, loading);
  loaded.function = over_values(loaded.function);
  const auto knots = loaded.function.knots();
  loaded.range = {knots.front().value, knots.back().value};
  loaded.name = fmt::format("{}, over the logarithm of {:.6g} to {:.6g}",
                            loaded.name.substr(0, loaded.name.find(" over ")), (*loaded.range)[0], (*loaded.range)[1]);
  loaded.warnings.insert(loaded.warnings.begin(), warnings.begin(), warnings.end());
  return loaded;
}

/// Advice for a function that is transparent over the field's values.
std::string remedy_for_clear(const LoadedTransferFunction& loaded, const TransferFunctionOptions& options,
                             const std::array<double, 2>& field, bool emits) {
  if (options.opacity_scale == 0) return "`opacity_scale` is 0; give a number above 0";
  const auto knots = loaded.function.knots();
  if (!loaded.function.visible(knots.front().value, knots.back().value, emits)) {
    if (!options.opacity_points.empty()) return "`opacity_points` are all 0; give at least one an opacity above 0";
    const bool has_opacities = loaded.unit_distance.has_value();
    return has_opacities ? "it has no opacity anywhere; `opacity_points` 0:0.03,1:0.2 gives it some"
                         : "its extinctions are all 0; write numbers above 0 in its last column";
  }
  if (options.range)
    return fmt::format("leave `range` out, or give values that the field has, as `range` {:.6g},{:.6g}", field[0],
                       field[1]);
  return "`rescale` stretches it over these values, `range` over other values";
}

/// Adds a warning if the image will be correct but show nothing.
void warn_of_nothing(const Dataset::State& data, const std::string& file_or_preset,
                     const TransferFunctionOptions& options, LoadedTransferFunction& loaded) {
  const auto [low, high] = data.facts.scalar_range;
  const auto knots = loaded.function.knots();
  const bool emits = options.emission == Emission::independent, chosen = !file_or_preset.empty() || options.range;
  if (knots.empty()) return;
  if (!loaded.function.visible(low, high, emits)) {
    if (options.with_surfaces) return;
    loaded.warnings.push_back(fmt::format(
        "the transfer function shows nothing: it is transparent for all of the field's values, {:.6g} to {:.6g}; {}",
        low, high, remedy_for_clear(loaded, options, {low, high}, emits)));
  } else if (chosen && !options.logarithmic && knots.size() > 1 &&
             colormaps::is_far_off({knots.front().value, knots.back().value}, data.facts_of_all().scalar_range)) {
    loaded.warnings.push_back(fmt::format(
        "the transfer function shows almost nothing: its range, {:.6g} to {:.6g}, contains hardly any of the field's "
        "values, {:.6g} to {:.6g}, or is so wide that nearly all of them have one colour and opacity; {}",
        knots.front().value, knots.back().value, low, high, remedy_for_clear(loaded, options, {low, high}, emits)));
  }
}

}  // namespace

LoadedTransferFunction transfer_function_of(const Dataset::State& data, const std::string& file_or_preset,
                                            const TransferFunctionOptions& options) {
  if (options.logarithmic) {
    LoadedTransferFunction loaded = logarithmic(data, file_or_preset, options);
    warn_of_nothing(data, file_or_preset, options, loaded);
    return loaded;
  }
  static const scene::FieldSamples none;
  const scene::FieldSamples& samples = file_or_preset.empty() ? data.field_samples() : none;
  LoadedTransferFunction loaded = load(
      file_or_preset, {&samples, data.samples != nullptr, data.shape, data.body_axes, data.tags.modality, data.labels},
      loading_options(data, options));
  warn_of_nothing(data, file_or_preset, options, loaded);
  return loaded;
}

}  // namespace tessera::api
