// SPDX-License-Identifier: BSD-3-Clause
// Replaces the drawing sources if TESSERA_CAIRO is OFF.
#include <fmt/format.h>

#include "analysis/chart_figure.hpp"
#include "analysis/timing_figure.hpp"
#include "tessera/error.hpp"

namespace tessera::analysis {

/// Programs call this before they measure, so that users do not wait for a figure that cannot be drawn.
void check_figure_path(const std::filesystem::path& file) {
  throw bad_input(fmt::format(
      "{}: figures need Cairo, which this build leaves out; build with TESSERA_CAIRO=ON, or write a table with `csv`",
      file.string()));
}

void write_chart(std::span<const ChartPoint>, const std::string&, const std::string&,
                 const std::filesystem::path& file) {
  check_figure_path(file);
}

void write_figure(std::span<const RunTime>, const std::filesystem::path& file) { check_figure_path(file); }

}  // namespace tessera::analysis
