// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "analysis/chart_measure.hpp"

namespace tessera::analysis {

/// Time against error, both logarithmic: a point a method, its spread of times as a bar, a line through each family,
/// the Pareto front as steps; what the front beats is pale. .svg or .png by name, appears by rename. Throws as
/// write_figure() of timing_figure.hpp does.
void write_chart(std::span<const ChartPoint> points, const std::string& title, const std::string& subtitle,
                 const std::filesystem::path& file);

}  // namespace tessera::analysis
