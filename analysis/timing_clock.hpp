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

  /// Makes ranges from any intervals; intervals that touch or overlap are joined.
  static TimeRanges of(std::vector<Range> any);
  [[nodiscard]] double length() const;
  [[nodiscard]] bool contains(double time) const;
};

/// The work of one process in a stage, in one role or one part of its time. timing_breakdown.hpp describes how it is
/// counted.
struct ProcessStage {
  double wall_us = 0, cpu_us = 0, thread_us = 0;
  std::uint64_t bytes = 0, messages = 0;
};

struct ProcessTime {
  std::vector<ProcessStage> in_frames, outside;  ///< one element for each stage of the trace
  TimeRanges frames;                             ///< when the process worked on frames
  double other_us = 0;                           ///< time in frames, but in no stage
  double busy_us = 0;                            ///< time in frames, summed over threads in stages other than `wait`
  int frame_count = 0;                           ///< number of `frame` spans; if 0, `frames` is the time of all spans
};

/// Divides the clock time of one process in one role among the stages. `spans` contains all spans of the process in
/// this role, in any order. `frame` and `wait` are the indices of these stages, or -1 if the trace does not have them.
/// If spans do not nest, which only occurs in edited traces, the later span is assumed to interrupt the earlier one.
ProcessTime share_clock(std::span<const FileSpan> spans, std::size_t stage_count, int frame, int wait);

}  // namespace tessera::analysis
