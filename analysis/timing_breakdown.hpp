// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tessera/trace_file.hpp"

/// Where a traced run spent its time: the breakdown of Juliachs, Carrard, Nominé, "Hybrid CPU-GPU Unstructured Meshes
/// Parallel Volume Rendering on PC Clusters", 2007, section 5, Figure 9 and Table 1.
///
/// The *whole* of a process in a role is the wall clock time while at least one of its `frame` spans runs. Every
/// instant of it is attributed to stages:
///   - to the stages in which the process's threads are at that instant, in equal parts per thread;
///   - a thread is in the innermost of its spans;
///   - `wait` only counts while no thread of the process does anything else;
///   - `other` is the time when no thread is in any stage.
/// So the stages of a process add up to its whole, and averages over processes add up to the average whole, as in the
/// paper. A stage that runs on one thread while the others idle gets all of the clock, which is its cost. CPU time is
/// the sum over the threads that recorded the stage. Time outside the frames (reading, partition) is counted
/// separately, in the same way.
///
/// If one rank has both roles, each is counted as if it were alone: a span states for which role its thread worked.
/// Spans of such a rank without a role belong to the projector up to `project`, otherwise to the compositor. A rank's
/// roles are those of its frames: work for another role (reading parts of the mesh) is counted with them.
namespace tessera::analysis {

/// One stage in the processes of one role. Times (microseconds) and counts are for the whole run, not per frame.
struct StageTime {
  std::string stage;
  double average_us = 0;                  ///< attributed wall clock time, mean over processes
  double worst_us = 0;                    ///< the largest of any process
  int worst_rank = 0;                     ///< the rank of that process
  double share = 0;                       ///< of the average whole
  double cpu_us = 0;                      ///< mean over processes
  double thread_us = 0;                   ///< time of threads in the stage, sum over processes
  std::uint64_t bytes = 0, messages = 0;  ///< sum over processes
};

/// All processes of one role.
struct RoleTime {
  TraceRole role = TraceRole::both;
  int processes = 0;
  bool has_frames = true;          ///< false: no `frame` span, so the whole is everything traced
  StageTime whole;                 ///< its CPU time and bytes are the sums over stages
  double busy_threads = 0;         ///< threads in a stage other than `wait`, mean over the whole
  std::vector<StageTime> stages;   ///< in frames, in the pipeline's order, `other` last
  std::vector<StageTime> outside;  ///< outside frames; share is 0

  /// The stage of this name in `stages`; null if no process was in it.
  [[nodiscard]] const StageTime* stage(const std::string& name) const;
  /// Largest wait over processes, as a share of the process's own whole; and its rank.
  double worst_wait_share = 0;
  int worst_wait_rank = 0;
};

/// How far exchange and frames overlap with projection. Shares are of all bytes of frames; none if the trace has no
/// such bytes or no frame numbers.
struct Overlap {
  std::optional<double> sent_before_projected;      ///< by projectors before the last one's last work on the frame
  std::optional<double> sent_before_frame_end;      ///< before the last projector's `frame` span ended
  std::optional<double> received_before_projected;  ///< by compositors
  std::optional<double> received_before_frame_end;
  int frames = 0;              ///< that have a previous frame
  int frames_overlapping = 0;  ///< that began projecting before the previous frame was composited
  double overlapping_us = 0;   ///< wall clock time when a frame was projected and the previous one composited
};

/// One run.
struct RunTime {
  std::string name;  ///< name of the file
  TraceRun run;
  int ranks = 0;                ///< with spans in the trace
  int frames = 0;               ///< rendered; divide times by it to get those of a frame
  double elapsed_us = 0;        ///< wall clock while any process works on a frame
  std::vector<RoleTime> roles;  ///< projectors, compositors, processes with both roles; only existing ones
  Overlap overlap;
  std::optional<double> kilotets_per_second;  ///< tets of the mesh x frames / elapsed; none if the mesh is unknown

  [[nodiscard]] const RoleTime* role(TraceRole role) const;
};

RunTime break_down(const TraceFile& trace, const std::string& name);

/// Parallel efficiency as in Table 1: rate per processor core relative to that of the smallest run (fewest ranks x
/// threads; the first of several) with the same input and image size; none if the rate is unknown.
std::vector<std::optional<double>> efficiencies(std::span<const RunTime> runs);

}  // namespace tessera::analysis
