// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tessera/trace_file.hpp"

namespace tessera::analysis {

/// Half-open intervals of time, sorted and disjoint.
struct TimeRanges {
  struct Range {
    double begin, end;
  };
  std::vector<Range> ranges;

  /// Joins intervals that touch or overlap.
  static TimeRanges of(std::vector<Range> any);
  [[nodiscard]] double length() const;
  [[nodiscard]] bool contains(double time) const;
};

/// The work of one process in one role, or in one part of its time; timing_breakdown.hpp describes the counting.
struct ProcessStage {
  double wall_us = 0, cpu_us = 0, thread_us = 0;
  std::uint64_t bytes = 0, messages = 0;
};

struct ProcessTime {
  std::vector<ProcessStage> in_frames, outside;  ///< one per stage of the trace
  TimeRanges frames;                             ///< when the process worked on frames
  double other_us = 0;                           ///< in frames, but in no stage
  double busy_us = 0;                            ///< in frames: threads in stages other than `wait`, summed
  int frame_count = 0;  ///< number of `frame` spans; 0: the frames are the time of all its spans
};

/// Divides the clock of one process in one role among its stages. `spans` are all of its spans, in any order; `frame`
/// and `wait` are the indices of these stages, or -1 if the trace has none. Spans that do not nest (only edited traces
/// have any) are treated as if the later one interrupted the earlier.
ProcessTime share_clock(std::span<const FileSpan> spans, std::size_t stage_count, int frame, int wait);

}  // namespace tessera::analysis
