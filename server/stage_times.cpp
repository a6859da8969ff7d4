// SPDX-License-Identifier: BSD-3-Clause
#include "server/stage_times.hpp"

#include <algorithm>
#include <string_view>

namespace tessera::server {

std::map<std::string, double> stage_times(std::vector<TraceSpan> spans, double frame_ms) {
  std::erase_if(spans, [](const TraceSpan& span) { return std::string_view(span.stage) == "frame"; });
  // Outer spans precede the spans inside them.
  std::ranges::sort(spans, [](const TraceSpan& a, const TraceSpan& b) {
    if (a.thread != b.thread) return a.thread < b.thread;
    if (a.start_us != b.start_us) return a.start_us < b.start_us;
    return a.wall_us > b.wall_us;
  });
  std::map<std::string, double> own;
  std::vector<const TraceSpan*> open;
  double sum = 0;
  for (const TraceSpan& span : spans) {
    while (!open.empty() &&
           (open.back()->thread != span.thread || open.back()->start_us + open.back()->wall_us <= span.start_us))
      open.pop_back();
    if (open.empty())
      sum += span.wall_us;
    else
      own[open.back()->stage] -= span.wall_us;
    own[span.stage] += span.wall_us;
    open.push_back(&span);
  }
  std::erase_if(own, [](const auto& stage) { return !(stage.second > 0); });
  if (sum > 0)
    for (auto& [stage, time] : own) time *= frame_ms / sum;
  return own;
}

}  // namespace tessera::server
