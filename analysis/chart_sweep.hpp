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

/// The compared pixels, and their reference values.
struct ChartTruth {
  std::vector<PixelIndex> pixels;
  std::vector<ReferencePixel> values;
  bool whole_image = false;
  double seconds = 0;
};

/// `pixels` random pixels; or as many as fit into `seconds`, found by larger and larger pilots.
ChartTruth chart_truth(const ChartScene& scene, double seconds, std::optional<std::size_t> pixels);

struct ChartBudget {
  std::chrono::steady_clock::time_point begin;
  double seconds;  ///< counted from `begin`
  int repeat;      ///< frames per method, if they fit
};

/// ChartPoint::left_out of a method that did not fit into the budget.
inline constexpr const char* no_room = "no room in the budget";

struct ChartSweep {
  std::vector<ChartPoint> points;  ///< one per method, in their order; `options` is left empty
  double missing_seconds = 0;      ///< estimated time of one frame each of the methods that did not fit
};

/// Times and compares all available methods. The first is always measured, others if the estimate from their family, or
/// a rough guess, fits. `measured` is called for each measured method. An Error of a method becomes its left_out.
ChartSweep sweep(const ChartScene& scene, const std::vector<ChartMethod>& methods, const ChartTruth& truth,
                 const ChartBudget& budget, const std::function<void(const ChartPoint&)>& measured);

}  // namespace tessera::analysis
