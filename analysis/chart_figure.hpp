// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "analysis/chart_measure.hpp"

namespace tessera::analysis {

/// Writes a chart of time against error, both logarithmic: a point for each method, with a bar for the spread of its
/// times, a line through each family, and the Pareto front as steps. Methods that are not on the front are pale. The
/// file is .svg or .png, depending on its name, and appears by rename. Throws the same errors as write_figure() of
/// timing_figure.hpp.
void write_chart(std::span<const ChartPoint> points, const std::string& title, const std::string& subtitle,
                 const std::filesystem::path& file);

}  // namespace tessera::analysis
