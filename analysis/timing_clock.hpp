// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tessera/trace_file.hpp"

namespace tessera::analysis {

/// Half-open stretches of time, sorted and apart from each other.
struct TimeRanges {
  struct Range {
    double begin, end;
  };
  std::vector<Range> ranges;

  /// Joins those that touch or overlap.
  static TimeRanges of(std::vector<Range> any);
  [[nodiscard]] double length() const;
  [[nodiscard]] bool contains(double time) const;
};

/// What one process did in one role, or in one part of its time; see timing_breakdown.hpp for how it is counted.
struct ProcessStage {
  double wall_us = 0, cpu_us = 0, thread_us = 0;
  std::uint64_t bytes = 0, messages = 0;
};

struct ProcessTime {
  std::vector<ProcessStage> in_frames, outside;  ///< one a stage of the trace
  TimeRanges frames;                             ///< when it worked on frames
  double other_us = 0;                           ///< of the frames: in no stage
  double busy_us = 0;                            ///< of the frames: threads in stages but `wait`, summed
  int frame_count = 0;                           ///< of its `frame` spans; 0: the frames are all of its spans' time
};

/// Shares the clock of one process in one role among its stages. `spans` are all of it, in any order; `frame` and
/// `wait` are the numbers of these stages, or -1 where the trace has none. Spans that do not nest (only edited traces
/// have any) are taken as if the later one interrupted the earlier.
ProcessTime share_clock(std::span<const FileSpan> spans, std::size_t stage_count, int frame, int wait);

}  // namespace tessera::analysis
