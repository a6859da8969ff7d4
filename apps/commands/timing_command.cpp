// SPDX-License-Identifier: BSD-3-Clause
#include "apps/commands/timing_command.hpp"

#include <fmt/format.h>

#include "analysis/timing_breakdown.hpp"
#include "analysis/timing_figure.hpp"
#include "analysis/timing_text.hpp"
#include "apps/render/progress.hpp"
#include "tessera/program/output_file.hpp"
#include "tessera/trace_file.hpp"

namespace tessera::apps {

void timing(const std::vector<std::filesystem::path>& traces, const std::filesystem::path& csv,
            const std::filesystem::path& figure) {
  if (!figure.empty()) analysis::check_figure_path(figure);
  for (const auto& trace : traces)
    for (const auto& output : {csv, figure})
      if (!output.empty()) check_output(output, trace);

  std::vector<analysis::RunTime> runs;
  runs.reserve(traces.size());
  StatusLine line(shows_progress(false));
  for (const auto& trace : traces) {
    line.begin("reading " + trace.filename().string());
    if (traces.size() > 1) line.advance(static_cast<double>(runs.size()) / static_cast<double>(traces.size()));
    runs.push_back(analysis::break_down(read_trace(trace), trace.string()));
  }
  line.begin("");

  for (const analysis::RunTime& run : runs) fmt::print("{}\n", analysis::breakdown_text(run));
  if (runs.size() > 1) fmt::print("{}\n", analysis::scaling_text(runs));
  fmt::print("{}", analysis::reading_text());

  if (!csv.empty()) write_text(csv, analysis::breakdown_csv(runs));
  if (!figure.empty()) analysis::write_figure(runs, figure);
}

}  // namespace tessera::apps
