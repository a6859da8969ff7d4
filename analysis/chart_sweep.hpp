// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/chart_measure.hpp"
#include "analysis/chart_methods.hpp"
#include "tessera/reference.hpp"

namespace tessera::analysis {

/// The pixels that are looked at, and what is right there.
struct ChartTruth {
  std::vector<PixelIndex> pixels;
  std::vector<ReferencePixel> values;
  bool whole_image = false;
  double seconds = 0;
};

/// So many random pixels; or as many as fit into that time, found by larger and larger pilots.
ChartTruth chart_truth(const ChartScene& scene, double seconds, std::optional<std::size_t> pixels);

struct ChartBudget {
  std::chrono::steady_clock::time_point begin;
  double seconds;  ///< from there
  int repeat;      ///< frames a method, if there is room
};

/// What ChartPoint::left_out says of a method that did not fit into the budget.
inline constexpr const char* no_room = "no room in the budget";

struct ChartSweep {
  std::vector<ChartPoint> points;  ///< one a method, in their order; `options` is left empty
  double missing_seconds = 0;      ///< what one frame each of the methods without room would take
};

/// Times and judges all methods that can be had. The first is measured in any case, others if what is known of their
/// family, or a rough guess, has room. `measured` hears of each that was. An Error of a method is why it is left out.
ChartSweep sweep(const ChartScene& scene, const std::vector<ChartMethod>& methods, const ChartTruth& truth,
                 const ChartBudget& budget, const std::function<void(const ChartPoint&)>& measured);

}  // namespace tessera::analysis
