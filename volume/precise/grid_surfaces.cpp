// SPDX-License-Identifier: BSD-3-Clause
#include "volume/precise/grid_surfaces.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

GridSurfaces::GridSurfaces(const Surfaces& surfaces, const scene::TransferFunction& function, const CellRanges& ranges)
    : set_(surfaces, function) {
  std::vector<float> lanes;  // lane scalars of the values, ascending
  for (const double value : set_.iso_values())
    lanes.push_back(integrals::lane_scalar(value, ranges.lanes.origin, ranges.lanes.unit));
  if (lanes.empty()) return;
  holding_.resize(ranges.count());
  // Rounding may have shifted ranges by two last places of a float and a unit.
  const auto moved = [](float s, float away) { return s + away * (std::abs(s) * 0x1p-22f + 1); };
  for (std::size_t cell = 0; cell < holding_.size(); ++cell) {
    if (!(ranges.low[cell] <= ranges.high[cell])) continue;
    const auto first = std::lower_bound(lanes.begin(), lanes.end(), moved(ranges.low[cell], -1));
    holding_[cell] = first != lanes.end() && *first <= moved(ranges.high[cell], 1) ? 1 : 0;
    any_ = any_ || holding_[cell] != 0;
  }
}

}  // namespace tessera::volume
