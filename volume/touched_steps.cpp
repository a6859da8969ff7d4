#include "volume/touched_steps.hpp"

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

}  // namespace

TouchedSteps::TouchedSteps(const LaneTable& table, const CellRanges& ranges, double largest_color, double least,
                           double longest) {
  double reach = 0, steepest = 0;
  for (std::size_t n = 0; n < ranges.count(); ++n) {
    if (!(ranges.low[n] <= ranges.high[n])) continue;
    reach =
        std::max({reach, std::abs(static_cast<double>(ranges.low[n])), std::abs(static_cast<double>(ranges.high[n]))});
    steepest = std::max(steepest, static_cast<double>(ranges.high[n]) - ranges.low[n]);
  }
  // Two roundings of the field itself, and places of 5e-7 voxel (packet_lanes-inl.h).
  noise = static_cast<float>(0x1p-23 * reach + 5e-7 * steepest);
  most = table.emission == scene::Emission::independent ? 1e18f : static_cast<float>(std::max(1.0, largest_color));
  const float* const edges = table.column(LaneTable::edge);
  std::vector<float> found(table.stride, 0.0f);
  bool any = false;
  for (std::size_t e = 1; e <= table.knot_count; ++e) {
    // Knots closer than the noise are one step.
    std::size_t below = e - 1, above = e;
    while (below > 0 && edges[below] > edges[e] - noise) --below;
    while (above < table.knot_count && edges[above + 1] < edges[e] + noise) ++above;
    const std::array<double, 4> low = matter_at(table, below,
                                                static_cast<double>(edges[e]) - (below < e - 1 ? noise : 0)),
                                high = matter_at(table, above, static_cast<double>(edges[e]) + (above > e ? noise : 0));
    const double opacity = std::abs(high[0] - low[0]);
    double light = 0;
    for (std::size_t c = 1; c < 4; ++c) light = std::max(light, std::abs(high[c] - low[c]));
    const double differs = std::min(1e18, std::max(opacity, light + opacity * largest_color));
    if (!(differs * longest > least)) continue;
    found[e] = static_cast<float>(differs);
    any = true;
  }
  if (any) weight = std::move(found);
}

}  // namespace tessera::volume
