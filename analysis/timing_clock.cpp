// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/timing_clock.hpp"

#include <algorithm>
#include <limits>

namespace tessera::analysis {
namespace {

/// An interval of one thread's time that belongs to a single span.
struct Piece {
  double begin, end;
  std::uint16_t stage;
};

/// Cuts the spans of one thread into pieces, each of which belongs to the innermost span. The spans are sorted: earlier
/// spans first, then longer spans first. Subtracts the CPU time of the spans inside a span from its `self_cpu`.
void cut(std::span<const FileSpan> spans, std::vector<Piece>& pieces, std::span<double> self_cpu) {
  std::vector<std::size_t> open;
  double now = 0;
  const auto end_of = [&](std::size_t i) { return spans[i].start_us + spans[i].wall_us; };
  const auto advance = [&](double to) {
    if (to > now) {
      pieces.push_back({now, to, spans[open.back()].stage});
      now = to;
    }
  };
  const auto close = [&] {
    advance(end_of(open.back()));
    open.pop_back();
  };
  for (std::size_t i = 0; i < spans.size(); ++i) {
    while (!open.empty() && end_of(open.back()) <= spans[i].start_us) close();
    if (open.empty()) {
      now = spans[i].start_us;
    } else {
      advance(spans[i].start_us);
      self_cpu[open.back()] = std::max(0.0, self_cpu[open.back()] - spans[i].cpu_us);
    }
    open.push_back(i);
  }
  while (!open.empty()) close();
}

/// Visits the instants at which something begins or ends, and attributes the time between them to stages.
class Sweep {
 public:
  Sweep(ProcessTime& result, std::size_t stage_count, int wait)
      : result_(&result), running_(stage_count), wait_(wait) {}

  void run(const std::vector<Piece>& pieces) {
    struct Change {
      double time;
      int stage;  ///< -1: a frame begins or ends
      int by;
    };
    std::vector<Change> changes;
    changes.reserve(2 * (pieces.size() + result_->frames.ranges.size()));
    for (const Piece& piece : pieces) {
      changes.push_back({piece.begin, piece.stage, 1});
      changes.push_back({piece.end, piece.stage, -1});
    }
    for (const auto& range : result_->frames.ranges) {
      changes.push_back({range.begin, -1, 1});
      changes.push_back({range.end, -1, -1});
    }
    std::sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) { return a.time < b.time; });
    for (std::size_t i = 0; i < changes.size(); ++i) {
      if (i > 0) give(changes[i].time - changes[i - 1].time);
      if (changes[i].stage < 0)
        in_frame_ += changes[i].by;
      else
        change(static_cast<std::size_t>(changes[i].stage), changes[i].by);
    }
  }

 private:
  void change(std::size_t stage, int by) {
    if (running_[stage] == 0) active_.push_back(stage);
    running_[stage] += by;
    if (running_[stage] == 0) std::erase(active_, stage);
    if (static_cast<int>(stage) != wait_) working_ += by;
  }

  void give(double time) {
    if (!(time > 0)) return;
    auto& stages = in_frame_ > 0 ? result_->in_frames : result_->outside;
    for (const std::size_t stage : active_) {
      stages[stage].thread_us += time * running_[stage];
      if (static_cast<int>(stage) != wait_)
        stages[stage].wall_us += time * running_[stage] / working_;
      else if (working_ == 0)
        stages[stage].wall_us += time;
    }
    if (in_frame_ > 0) {
      result_->busy_us += time * working_;
      if (active_.empty()) result_->other_us += time;
    }
  }

  ProcessTime* result_;
  std::vector<int> running_;         ///< number of threads currently in each stage
  std::vector<std::size_t> active_;  ///< stages that contain a thread
  int wait_, working_ = 0, in_frame_ = 0;
};

}  // namespace

TimeRanges TimeRanges::of(std::vector<Range> any) {
  std::sort(any.begin(), any.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
  TimeRanges joined;
  for (const Range& range : any)
    if (!joined.ranges.empty() && range.begin <= joined.ranges.back().end)
      joined.ranges.back().end = std::max(joined.ranges.back().end, range.end);
    else
      joined.ranges.push_back(range);
  return joined;
}

double TimeRanges::length() const {
  double sum = 0;
  for (const Range& range : ranges) sum += range.end - range.begin;
  return sum;
}

bool TimeRanges::contains(double time) const {
  const auto after = std::upper_bound(ranges.begin(), ranges.end(), time,
                                      [](double t, const Range& range) { return t < range.begin; });
  return after != ranges.begin() && time <= std::prev(after)->end;
}

ProcessTime share_clock(std::span<const FileSpan> spans, std::size_t stage_count, int frame, int wait) {
  ProcessTime result;
  result.in_frames.resize(stage_count);
  result.outside.resize(stage_count);

  std::vector<FileSpan> work;
  std::vector<TimeRanges::Range> frames;
  TimeRanges::Range all{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const FileSpan& span : spans) {
    const TimeRanges::Range range{span.start_us, span.start_us + span.wall_us};
    if (static_cast<int>(span.stage) == frame) {
      frames.push_back(range);
      continue;
    }
    work.push_back(span);
    all = {std::min(all.begin, range.begin), std::max(all.end, range.end)};
  }
  result.frame_count = static_cast<int>(frames.size());
  if (frames.empty() && !work.empty()) frames.push_back(all);
  result.frames = TimeRanges::of(std::move(frames));

  std::sort(work.begin(), work.end(), [](const FileSpan& a, const FileSpan& b) {
    if (a.thread != b.thread) return a.thread < b.thread;
    return a.start_us != b.start_us ? a.start_us < b.start_us : a.wall_us > b.wall_us;
  });
  std::vector<double> self_cpu(work.size());
  for (std::size_t i = 0; i < work.size(); ++i) self_cpu[i] = work[i].cpu_us;
  std::vector<Piece> pieces;
  for (std::size_t begin = 0, end = 0; begin < work.size(); begin = end) {
    while (end < work.size() && work[end].thread == work[begin].thread) ++end;
    cut(std::span(work).subspan(begin, end - begin), pieces, std::span(self_cpu).subspan(begin, end - begin));
  }
  Sweep(result, stage_count, wait).run(pieces);

  // Quantities without an extent in time are attributed to the middle of their span.
  for (std::size_t i = 0; i < work.size(); ++i) {
    const bool framed = result.frames.contains(work[i].start_us + work[i].wall_us / 2);
    ProcessStage& stage = (framed ? result.in_frames : result.outside)[work[i].stage];
    stage.cpu_us += self_cpu[i];
    stage.bytes += work[i].bytes;
    stage.messages += work[i].messages;
  }
  return result;
}

}  // namespace tessera::analysis
