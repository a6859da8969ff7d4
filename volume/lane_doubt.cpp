#include "volume/lane_doubt.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::volume {
namespace {

using compositor::LaneTable;

/// Extinction and what it sends per unit of length, in one interval of the table.
std::array<double, 4> matter_at(const LaneTable& table, std::size_t interval, double s) {
  const auto channel = [&](int c) {
    const double start = table.column(c)[interval], slope = table.column(c + 1)[interval];
    return slope == 0 ? start : start + slope * (s - table.column(LaneTable::base)[interval]);
  };
  const double extinction = 2 * channel(LaneTable::half_extinction);
  const double light = table.emission == scene::Emission::independent ? 1 : extinction;
  return {extinction, light * channel(LaneTable::red), light * channel(LaneTable::green),
          light * channel(LaneTable::blue)};
}

/// Light and opacity, per unit of length, in which two of them differ.
double difference(const std::array<double, 4>& a, const std::array<double, 4>& b, double largest_color) {
  double light = 0;
  for (std::size_t c = 1; c < 4; ++c) light = std::max(light, std::abs(a[c] - b[c]));
  const double opacity = std::abs(a[0] - b[0]);
  return std::min(1e18, std::max(opacity, light + opacity * largest_color));
}

/// Of numbers, those that matter; none if none does.
std::vector<float> those_above(double least, std::vector<float> numbers) {
  bool any = false;
  for (float& n : numbers) {
    if (!(n > least)) n = 0;
    any = any || n > 0;
  }
  return any ? numbers : std::vector<float>();
}

}  // namespace

LaneDoubt::LaneDoubt(const LaneTable& table, const CellRanges& ranges, double largest_color, double least,
                     double longest) {
  double reach = 0, steepest = 0;
  for (std::size_t n = 0; n < ranges.count(); ++n) {
    const double low = ranges.low[n], high = ranges.high[n];
    if (!(low <= high)) continue;
    reach = std::max({reach, std::abs(low), std::abs(high)});
    steepest = std::max(steepest, high - low);
  }
  // Two roundings of the field itself, and places of 5e-7 voxel (packet_lanes-inl.h).
  noise = static_cast<float>(0x1p-23 * reach + 5e-7 * steepest);
  if (table.emission != scene::Emission::independent)
    most = static_cast<float>(std::max(1.0, largest_color));
  else
    most = 1e18f;

  const float* const edges = table.column(LaneTable::edge);
  step.assign(table.stride, 0.0f), ramp.assign(table.stride, 0.0f);
  for (std::size_t e = 1; e <= table.knot_count; ++e) {
    // Knots closer than the noise are one step.
    std::size_t below = e - 1, above = e;
    while (below > 0 && edges[below] > edges[e] - noise) --below;
    while (above < table.knot_count && edges[above + 1] < edges[e] + noise) ++above;
    step[e] =
        static_cast<float>(difference(matter_at(table, below, edges[e] - (below < e - 1 ? noise : 0.0f)),
                                      matter_at(table, above, edges[e] + (above > e ? noise : 0.0f)), largest_color));
    if (e == table.knot_count) continue;
    // Over many voxels roundings mostly cancel; of the noise, which bounds them, a sixteenth is left (measured where
    // peaks are narrow, docs/ACCURACY.md).
    const double width = static_cast<double>(edges[e + 1]) - edges[e];
    ramp[e] =
        static_cast<float>(std::min(1.0, noise / 16 / width) *
                           difference(matter_at(table, e, edges[e]), matter_at(table, e, edges[e + 1]), largest_color));
  }
  step = those_above(least / longest, std::move(step));
  ramp = those_above(least / longest / 256, std::move(ramp));
}

}  // namespace tessera::volume
