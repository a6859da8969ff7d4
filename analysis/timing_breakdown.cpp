// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/timing_breakdown.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "analysis/timing_clock.hpp"

namespace tessera::analysis {
namespace {

constexpr std::array pipeline = {"read",    "partition", "prepare",   "transform", "cull",  "bin",
                                 "project", "sort",      "integrate", "composite", "pack",  "send",
                                 "receive", "wait",      "assemble",  "write",     "verify"};

std::size_t place_in_pipeline(std::string_view stage) {
  return static_cast<std::size_t>(std::find(pipeline.begin(), pipeline.end(), stage) - pipeline.begin());
}

int stage_number(const TraceFile& trace, std::string_view stage) {
  const auto at = std::find(trace.stages.begin(), trace.stages.end(), stage);
  return at == trace.stages.end() ? -1 : static_cast<int>(at - trace.stages.begin());
}

struct Process {
  int rank;
  TraceRole role;
  ProcessTime time;
};

std::vector<Process> processes_of(const TraceFile& trace) {
  const int frame = stage_number(trace, "frame"), wait = stage_number(trace, "wait");
  std::map<int, std::set<TraceRole>> roles_of_rank, roles_with_frames;
  for (const FileSpan& span : trace.spans)
    if (span.role != TraceRole::both) {
      roles_of_rank[span.rank].insert(span.role);
      if (span.stage == frame) roles_with_frames[span.rank].insert(span.role);
    }
  for (const auto& [rank, roles] : roles_with_frames) roles_of_rank[rank] = roles;

  const auto role_of = [&](const FileSpan& span) {
    const auto roles = roles_of_rank.find(span.rank);
    if (roles == roles_of_rank.end() || roles->second.contains(span.role)) return span.role;
    if (roles->second.size() == 1) return *roles->second.begin();
    return place_in_pipeline(trace.stages[span.stage]) <= place_in_pipeline("project") ? TraceRole::projector
                                                                                       : TraceRole::compositor;
  };
  std::map<std::pair<TraceRole, int>, std::vector<FileSpan>> spans_of;
  for (const FileSpan& span : trace.spans) spans_of[{role_of(span), span.rank}].push_back(span);

  std::vector<Process> processes;
  for (auto& [key, spans] : spans_of) {
    processes.push_back({key.second, key.first, share_clock(spans, trace.stages.size(), frame, wait)});
    spans = {};
  }
  return processes;
}

/// Computes the mean and the worst values of a stage over processes.
class Merge {
 public:
  Merge(std::string stage, std::size_t processes) : processes_(static_cast<double>(processes)) {
    merged_.stage = std::move(stage);
  }
  void add(int rank, const ProcessStage& stage) {
    if (stage.wall_us > merged_.worst_us || first_) {
      merged_.worst_us = stage.wall_us;
      merged_.worst_rank = rank;
    }
    first_ = false;
    merged_.average_us += stage.wall_us / processes_;
    merged_.cpu_us += stage.cpu_us / processes_;
    merged_.thread_us += stage.thread_us;
    merged_.bytes += stage.bytes;
    merged_.messages += stage.messages;
  }
  [[nodiscard]] StageTime result(double whole_us = 0) const {
    StageTime merged = merged_;
    if (whole_us > 0) merged.share = merged.average_us / whole_us;
    return merged;
  }
  [[nodiscard]] bool empty() const {
    return merged_.thread_us == 0 && merged_.cpu_us == 0 && merged_.bytes == 0 && merged_.messages == 0;
  }

 private:
  double processes_;
  bool first_ = true;
  StageTime merged_;
};

RoleTime role_time(const TraceFile& trace, TraceRole role, std::span<const Process> processes) {
  RoleTime time;
  time.role = role;
  time.processes = static_cast<int>(processes.size());
  const int wait = stage_number(trace, "wait");

  Merge whole("whole", processes.size()), other("other", processes.size());
  double busy_us = 0, framed_us = 0;
  for (const auto& [rank, ignored, process] : processes) {
    ProcessStage sum;
    for (const ProcessStage& stage : process.in_frames) {
      sum.cpu_us += stage.cpu_us;
      sum.bytes += stage.bytes;
      sum.messages += stage.messages;
      sum.thread_us += stage.thread_us;
    }
    sum.wall_us = process.frames.length();
    whole.add(rank, sum);
    other.add(rank, {process.other_us, 0, 0, 0, 0});
    busy_us += process.busy_us;
    framed_us += sum.wall_us;
    time.has_frames = time.has_frames && process.frame_count > 0;
    if (wait >= 0 && sum.wall_us > 0) {
      const double share = process.in_frames[static_cast<std::size_t>(wait)].wall_us / sum.wall_us;
      if (share > time.worst_wait_share) {
        time.worst_wait_share = share;
        time.worst_wait_rank = rank;
      }
    }
  }
  time.whole = whole.result(whole.result().average_us);
  if (framed_us > 0) time.busy_threads = busy_us / framed_us;

  std::vector<std::size_t> order(trace.stages.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return place_in_pipeline(trace.stages[a]) < place_in_pipeline(trace.stages[b]);
  });
  for (const std::size_t stage : order) {
    Merge inside(trace.stages[stage], processes.size()), outside = inside;
    for (const Process& process : processes) {
      inside.add(process.rank, process.time.in_frames[stage]);
      outside.add(process.rank, process.time.outside[stage]);
    }
    if (!inside.empty()) time.stages.push_back(inside.result(time.whole.average_us));
    // Times of less than a microsecond are due to the rounding of times in the file.
    if (!outside.empty() && outside.result().worst_us >= 1) time.outside.push_back(outside.result());
  }
  time.stages.push_back(other.result(time.whole.average_us));
  return time;
}

/// The time interval of work on one frame, over all processes of a role.
struct FrameExtent {
  double begin = std::numeric_limits<double>::infinity();
  double end = -std::numeric_limits<double>::infinity();
  double last_work = -std::numeric_limits<double>::infinity();  ///< end of the last work except exchange and waiting
};

Overlap overlap_of(const TraceFile& trace) {
  const int frame = stage_number(trace, "frame"), send = stage_number(trace, "send"),
            receive = stage_number(trace, "receive"), wait = stage_number(trace, "wait");
  std::map<int, FrameExtent> projected, composited;
  for (const FileSpan& span : trace.spans) {
    if (span.frame < 0 || span.role == TraceRole::both) continue;
    FrameExtent& extent = (span.role == TraceRole::projector ? projected : composited)[span.frame];
    const double end = span.start_us + span.wall_us;
    if (span.stage == frame) {
      extent.begin = std::min(extent.begin, span.start_us);
      extent.end = std::max(extent.end, end);
    } else if (span.stage != send && span.stage != receive && span.stage != wait) {
      extent.last_work = std::max(extent.last_work, end);
    }
  }

  Overlap overlap;
  std::array<double, 2> bytes{}, before_work{}, before_end{};  // index 0: sent, 1: received
  for (const FileSpan& span : trace.spans) {
    const bool sent = span.stage == send && span.role == TraceRole::projector;
    const bool received = span.stage == receive && span.role == TraceRole::compositor;
    const auto extent = projected.find(span.frame);
    if (!(sent || received) || extent == projected.end()) continue;
    // Bytes are assumed to move at a constant rate during their span.
    const auto before = [&](double time) {
      if (time >= span.start_us + span.wall_us) return 1.0;
      return span.wall_us > 0 ? std::clamp((time - span.start_us) / span.wall_us, 0.0, 1.0) : 0.0;
    };
    const std::size_t direction = sent ? 0 : 1;
    const auto moved = static_cast<double>(span.bytes);
    bytes[direction] += moved;
    before_work[direction] += moved * before(extent->second.last_work);
    before_end[direction] += moved * before(extent->second.end);
  }
  if (bytes[0] > 0) {
    overlap.sent_before_projected = before_work[0] / bytes[0];
    overlap.sent_before_frame_end = before_end[0] / bytes[0];
  }
  if (bytes[1] > 0) {
    overlap.received_before_projected = before_work[1] / bytes[1];
    overlap.received_before_frame_end = before_end[1] / bytes[1];
  }
  for (const auto& [number, extent] : projected) {
    const auto before = composited.find(number - 1);
    if (before == composited.end() || !(before->second.end > before->second.begin) || !(extent.end > extent.begin))
      continue;
    ++overlap.frames;
    const double common = std::min(extent.end, before->second.end) - std::max(extent.begin, before->second.begin);
    if (common > 0) {
      ++overlap.frames_overlapping;
      overlap.overlapping_us += common;
    }
  }
  return overlap;
}

}  // namespace

const StageTime* RoleTime::stage(const std::string& name) const {
  const auto at = std::find_if(stages.begin(), stages.end(), [&](const StageTime& s) { return s.stage == name; });
  return at == stages.end() ? nullptr : &*at;
}

const RoleTime* RunTime::role(TraceRole wanted) const {
  const auto at = std::find_if(roles.begin(), roles.end(), [&](const RoleTime& r) { return r.role == wanted; });
  return at == roles.end() ? nullptr : &*at;
}

RunTime break_down(const TraceFile& trace, const std::string& name) {
  RunTime run;
  run.name = name;
  run.run = trace.run;
  const std::vector<Process> processes = processes_of(trace);

  std::set<int> ranks;
  std::vector<TimeRanges::Range> worked;
  for (const Process& process : processes) {
    ranks.insert(process.rank);
    run.frames = std::max(run.frames, process.time.frame_count);
    worked.insert(worked.end(), process.time.frames.ranges.begin(), process.time.frames.ranges.end());
  }
  run.ranks = static_cast<int>(ranks.size());
  if (run.frames == 0) run.frames = std::max(1, trace.run.frames);
  run.elapsed_us = TimeRanges::of(std::move(worked)).length();
  if (run.run.tets > 0 && run.elapsed_us > 0)
    run.kilotets_per_second = static_cast<double>(run.run.tets) * run.frames / (run.elapsed_us * 1e-6) / 1000;

  for (const TraceRole role : {TraceRole::projector, TraceRole::compositor, TraceRole::both}) {
    std::vector<Process> of_role;
    std::copy_if(processes.begin(), processes.end(), std::back_inserter(of_role),
                 [&](const Process& process) { return process.role == role; });
    if (!of_role.empty()) run.roles.push_back(role_time(trace, role, of_role));
  }
  run.overlap = overlap_of(trace);
  return run;
}

std::vector<std::optional<double>> efficiencies(std::span<const RunTime> runs) {
  const auto work = [](const RunTime& run) {
    return std::tuple(std::filesystem::path(run.run.input).filename(), run.run.tets, run.run.width, run.run.height);
  };
  const auto cores = [](const RunTime& run) {
    return std::max(run.ranks, run.run.ranks) * std::max(run.run.threads, 1);
  };
  std::vector<std::optional<double>> found;
  for (const RunTime& run : runs) {
    const RunTime* smallest = nullptr;
    for (const RunTime& candidate : runs)
      if (candidate.kilotets_per_second && work(candidate) == work(run) &&
          (smallest == nullptr || cores(candidate) < cores(*smallest)))
        smallest = &candidate;
    if (run.kilotets_per_second && smallest != nullptr)
      found.emplace_back(*run.kilotets_per_second / cores(run) * cores(*smallest) / *smallest->kilotets_per_second);
    else
      found.emplace_back();
  }
  return found;
}

}  // namespace tessera::analysis
