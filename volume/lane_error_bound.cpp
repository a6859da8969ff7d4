// SPDX-License-Identifier: BSD-3-Clause
#include "volume/lane_error_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace tessera::volume {
namespace {

using integrals::LaneTable;

/// The values of one interval of the table at a scalar.
struct Matter {
  double extinction = 0;
  std::array<double, 3> color{};
};

Matter matter_at(const LaneTable& table, std::size_t interval, double s) {
  const auto channel = [&](int c) {
    const double start = table.column(c)[interval], slope = table.column(c + 1)[interval];
    return slope == 0 ? start : start + slope * (s - table.column(LaneTable::base)[interval]);
  };
  return {2 * channel(LaneTable::half_extinction),
          {channel(LaneTable::red), channel(LaneTable::green), channel(LaneTable::blue)}};
}

/// Returns the largest difference of two colours, each multiplied by a factor.
double color_difference(const Matter& a, double times_a, const Matter& b, double times_b) {
  double most = 0;
  for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(times_a * a.color[c] - times_b * b.color[c]));
  return most;
}

/// Returns the difference of two media in light and opacity, per unit of length.
double difference(const Matter& a, const Matter& b, bool independent, double brightest) {
  const double light = color_difference(a, independent ? 1 : a.extinction, b, independent ? 1 : b.extinction);
  const double opacity = std::abs(a.extinction - b.extinction);
  return std::min(1e18, std::max(opacity, light + opacity * brightest));
}

/// Sets numbers that are not above `least` to zero; returns an empty vector if none is above.
std::vector<float> those_above(double least, std::vector<float> numbers) {
  bool any = false;
  for (float& n : numbers) {
    if (!(n > least)) n = 0;
    any = any || n > 0;
  }
  return any ? numbers : std::vector<float>();
}

float bounded(double x) { return static_cast<float>(std::min(x, 1e18)); }

/// Returns, for each edge of the table, the distance by which rounding moved its knots, in lane scalars.
std::vector<double> knots_moved(const scene::TransferFunction& function, const LaneTable& table,
                                const CellRanges& ranges) {
  const float* const edges = table.column(LaneTable::edge);
  std::vector<double> moved(table.stride, 0.0);
  for (const scene::Knot& knot : function.knots()) {
    const double exact = (knot.value - ranges.lanes.origin) / ranges.lanes.unit;
    const auto at = std::lower_bound(table.edge_values.begin() + 1, table.edge_values.end(), knot.value,
                                     [](const std::array<double, 2>& values, double v) { return values[1] < v; });
    const auto e = static_cast<std::size_t>(at - table.edge_values.begin());
    if (e <= table.knot_count && (*at)[0] <= knot.value && std::abs(exact) < 0x1p30)
      moved[e] = std::max(moved[e], std::abs(edges[e] - exact));
  }
  return moved;
}

/// Returns the knots that are merged into an edge of the table if they have different values; otherwise no knots.
std::span<const scene::Knot> knots_at(const scene::TransferFunction& function, const LaneTable& table,
                                      std::size_t edge) {
  const auto& [least, largest] = table.edge_values[edge];
  if (least == largest) return {};
  const auto knots = function.knots();
  const auto first = std::lower_bound(knots.begin(), knots.end(), least,
                                      [](const scene::Knot&knot, double v) { return knot.value < v; }),
             last = std::upper_bound(first, knots.end(), largest,
                                     [](double v, const scene::Knot&knot) { return v < knot.value; });
  return {first, last};
}

}  // namespace

LaneErrorBound::LaneErrorBound(const scene::TransferFunction& function, const LaneTable& table,
                               const CellRanges& ranges, const ErrorBoundSettings& settings)
    : brightest(bounded(std::max(1.0, settings.brightest))), matters(bounded(settings.least / 64)) {
  find_noise(ranges, settings.cell_data);
  most = table.emission != scene::Emission::independent ? bounded(std::max(1.0, settings.largest_color)) : 1e18f;
  find_sharp_edges(table, ranges.lanes);
  find_steps(function, table, settings);
  find_ramps(table, knots_moved(function, table, ranges), settings);
  const bool independent = table.emission == scene::Emission::independent;
  double densest = 0;
  for (std::size_t n = 0; n <= table.knot_count; ++n)
    for (const double s : {table.column(LaneTable::edge)[n], table.column(LaneTable::edge)[n + 1]})
      if (std::isfinite(s))
        densest = std::max(densest, difference(matter_at(table, n, s), {}, independent, settings.brightest));
  // The positions of the ends have an error of 1e-6 voxels.
  ends = 4e-6 * densest * settings.longest > settings.least;
}

void LaneErrorBound::find_noise(const CellRanges& ranges, bool cell_data) {
  double reach = 0, steepest = 0;
  for (std::size_t n = 0; n < ranges.count(); ++n) {
    const double low = ranges.low[n], high = ranges.high[n];
    if (!(low <= high)) continue;
    reach = std::max({reach, std::abs(low), std::abs(high)});
    steepest = std::max(steepest, high - low);
  }
  // The noise consists of two roundings of the field and of positions with an error of 5e-7 voxels
  // (packet_lanes-inl.h). For cell data, it consists of the rounding of the sample and of an edge. It is at least the
  // last place of a float of this size, so that adding the noise to an edge has an effect.
  noise = bounded(cell_data ? (ranges.lanes.exact ? 0x1p-23 : 0x1p-22) * reach : 0x1p-23 * reach + 5e-7 * steepest);
}

void LaneErrorBound::find_sharp_edges(const LaneTable& table, const LaneSamples& lanes) {
  sharp.assign(table.stride, 0);
  for (std::size_t e = 1; e <= table.knot_count; ++e) sharp[e] = lanes.exact && table.is_step[e] != 0;
}

void LaneErrorBound::find_steps(const scene::TransferFunction& function, const LaneTable& table,
                                const ErrorBoundSettings& settings) {
  const float* const edges = table.column(LaneTable::edge);
  const bool independent = table.emission == scene::Emission::independent;
  for (std::vector<float>* each : {&step, &step_extinction, &step_red, &step_green, &step_blue, &step_light})
    each->assign(table.stride, 0.0f);
  for (std::size_t e = 1; e <= table.knot_count; ++e) {
    // Knots that are closer together than the noise are treated as one step.
    std::size_t below = e - 1, above = e;
    while (below > 0 && edges[below] > edges[e] - noise) --below;
    while (above < table.knot_count && edges[above + 1] < edges[e] + noise) ++above;
    const Matter a = matter_at(table, below, edges[e] - (below < e - 1 ? noise : 0.0f)),
                 b = matter_at(table, above, edges[e] + (above > e ? noise : 0.0f));
    // Cell data takes only the values of samples, which the table represents exactly.
    if (settings.cell_data && sharp[e] != 0) continue;
    double differs = difference(a, b, independent, settings.brightest), colors = color_difference(a, 1, b, 1);
    Matter dense = a.extinction > b.extinction ? a : b, thin = a.extinction > b.extinction ? b : a;
    for (const scene::Knot& knot : knots_at(function, table, e)) {
      const double color_unit = independent ? settings.unit : 1;
      const Matter m{knot.extinction * settings.unit,
                     {knot.color.x * color_unit, knot.color.y * color_unit, knot.color.z * color_unit}};
      // Two knots differ by at most the sum of their differences from `a`.
      differs = std::max(differs, 2 * difference(m, a, independent, settings.brightest));
      colors = std::max(colors, 2 * color_difference(m, 1, a, 1));
      if (m.extinction > dense.extinction) dense = m;
      if (m.extinction < thin.extinction) thin = m;
    }
    step[e] = bounded(differs);
    step_extinction[e] = bounded(dense.extinction - thin.extinction);
    step_light[e] = bounded((independent ? 1 : thin.extinction) * colors);
    if (independent) continue;
    step_red[e] = bounded(dense.color[0]), step_green[e] = bounded(dense.color[1]);
    step_blue[e] = bounded(dense.color[2]);
  }
  step = those_above(settings.least / settings.longest, std::move(step));
}

void LaneErrorBound::find_ramps(const LaneTable& table, const std::vector<double>& moved,
                                const ErrorBoundSettings& settings) {
  const float* const edges = table.column(LaneTable::edge);
  const bool independent = table.emission == scene::Emission::independent;
  for (std::vector<float>* each : {&ramp, &ramp_extinction, &ramp_color}) each->assign(table.stride, 0.0f);
  for (std::size_t e = 1; e < table.knot_count; ++e) {
    const Matter a = matter_at(table, e, edges[e]), b = matter_at(table, e, edges[e + 1]);
    const double width = static_cast<double>(edges[e + 1]) - edges[e],
                 all = difference(a, b, independent, settings.brightest), share = std::min(1.0, noise / 8 / width),
                 steadily = std::max(moved[e], moved[e + 1]) / width;
    ramp[e] = bounded(share * all);
    if (share * all > settings.least / settings.longest / 128)
      steady = std::max(steady, static_cast<float>(std::min(1.0, share / 2 + steadily) / share));
    ramp_extinction[e] = bounded(std::min(1.0, share + steadily) * std::abs(b.extinction - a.extinction));
    ramp_color[e] = bounded(std::min(1.0, share + steadily) * color_difference(a, 1, b, 1));
  }
  ramp = those_above(settings.least / settings.longest / 128, std::move(ramp));
}

}  // namespace tessera::volume
