// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "analysis/chart_measure.hpp"

namespace tessera::analysis {

/// Time against error, both logarithmic: one point per method, the spread of its times as a bar, a line through each
/// family, and the Pareto front as steps; methods behind the front are pale. Written as .svg or .png by the file's
/// name; appears by rename. Throws as write_figure() of timing_figure.hpp.
void write_chart(std::span<const ChartPoint> points, const std::string& title, const std::string& subtitle,
                 const std::filesystem::path& file);

}  // namespace tessera::analysis
