#include "apps/timing_command.hpp"

#include <fmt/format.h>

#include "apps/output_check.hpp"
#include "apps/timing_breakdown.hpp"
#include "apps/timing_figure.hpp"
#include "apps/timing_text.hpp"
#include "io/atomic_file.hpp"
#include "io/chrome_trace_reader.hpp"

namespace tessera::apps {

void timing(const std::vector<std::filesystem::path>& traces, const std::filesystem::path& csv,
            const std::filesystem::path& figure) {
  if (!figure.empty()) check_figure_path(figure);
  for (const auto& trace : traces)
    for (const auto& output : {csv, figure})
      if (!output.empty()) check_output_file(output, trace);

  std::vector<RunTime> runs;
  runs.reserve(traces.size());
  for (const auto& trace : traces) runs.push_back(break_down(io::read_chrome_trace(trace), trace.string()));

  for (const RunTime& run : runs) fmt::print("{}\n", breakdown_text(run));
  if (runs.size() > 1) fmt::print("{}\n", scaling_text(runs));
  fmt::print("{}", reading_text());

  if (!csv.empty()) {
    io::AtomicFile file(csv);
    file.write(breakdown_csv(runs));
    file.commit();
  }
  if (!figure.empty()) write_figure(runs, figure);
}

}  // namespace tessera::apps
