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

/// Computes the reference for `pixels` random pixels. Without a number, computes as many pixels as `seconds` allow;
/// pilots of increasing size determine how many.
ChartTruth chart_truth(const ChartScene& scene, double seconds, std::optional<std::size_t> pixels);

struct ChartBudget {
  std::chrono::steady_clock::time_point begin;
  double seconds;  ///< budget, counted from `begin`
  int repeat;      ///< number of frames per method, if the budget allows
};

/// ChartPoint::left_out of a method for which the budget was too small.
inline constexpr const char* no_room = "no room in the budget";

struct ChartSweep {
  std::vector<ChartPoint> points;  ///< one for each method, in the order of the methods; `options` is not set
  double missing_seconds = 0;      ///< estimated time for one frame of each method that was left out for lack of time
};

/// Times and compares all available methods. The first method is always measured. Another method is measured if its
/// time, estimated from its family or by a rough guess, is within the budget. `measured` is called for each measured
/// method. If a method throws an Error, the method's `left_out` becomes the error's text.
ChartSweep sweep(const ChartScene& scene, const std::vector<ChartMethod>& methods, const ChartTruth& truth,
                 const ChartBudget& budget, const std::function<void(const ChartPoint&)>& measured);

}  // namespace tessera::analysis
