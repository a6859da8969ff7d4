// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tessera/trace_file.hpp"

/// Where the time of a traced run went: the breakdown of Juliachs, Carrard, Nominé, "Hybrid CPU-GPU Unstructured Meshes
/// Parallel Volume Rendering on PC Clusters", 2007, section 5, Figure 9 and Table 1.
///
/// The *whole* of a process in a role is the wall clock while at least one of its `frame` spans runs. Every instant of
/// it is given to stages:
///   - to those that the process's threads are in at that instant, evenly to each thread if they do several things;
///   - a thread is in the innermost of its spans;
///   - `wait` counts only while no thread of the process does anything else;
///   - `other` is the time when no thread is in any stage.
/// So a process's stages add up to its whole, and averages over processes add up to the average whole, as in the paper.
/// A stage that runs on one thread while the others idle has all of the clock, which is what it costs.
/// CPU time is the sum over the threads that recorded the stage. What lies outside of the frames (reading, partition)
/// is counted apart, in the same way.
///
/// Where one rank has both roles, each is counted as if it were alone: their spans say for which of them a thread
/// worked. Spans of such a rank that say no role belong to the projector up to `project`, else to the compositor. A
/// rank's roles are those of its frames: what it did for another one (reading parts of the mesh) is counted with them.
namespace tessera::analysis {

/// One stage in the processes of one role. Times in microseconds and counts are of the run, not of a frame.
struct StageTime {
  std::string stage;
  double average_us = 0;                  ///< wall clock given to it, mean over processes
  double worst_us = 0;                    ///< the most that a process has
  int worst_rank = 0;                     ///< and which one
  double share = 0;                       ///< of the average whole
  double cpu_us = 0;                      ///< mean over processes
  double thread_us = 0;                   ///< time of threads in it, sum over processes
  std::uint64_t bytes = 0, messages = 0;  ///< sum over processes
};

/// All processes of one role.
struct RoleTime {
  TraceRole role = TraceRole::both;
  int processes = 0;
  bool has_frames = true;          ///< false: no `frame` span, so the whole is all that was traced
  StageTime whole;                 ///< its CPU time and bytes are the sums over stages
  double busy_threads = 0;         ///< threads in a stage but `wait`, mean over the whole
  std::vector<StageTime> stages;   ///< in frames, in the pipeline's order, `other` last
  std::vector<StageTime> outside;  ///< not in frames; share is 0

  /// The named stage of `stages`; null if no process was in it.
  [[nodiscard]] const StageTime* stage(const std::string& name) const;
  /// Worst over processes, as a share of that process's own whole; and which.
  double worst_wait_share = 0;
  int worst_wait_rank = 0;
};

/// How far exchange and frames overlap with projection. Shares are of all bytes of frames; none where the trace has no
/// such bytes or no frame numbers.
struct Overlap {
  std::optional<double> sent_before_projected;      ///< by projectors before the last one's last work on the frame
  std::optional<double> sent_before_frame_end;      ///< before the last projector's `frame` span ended
  std::optional<double> received_before_projected;  ///< by compositors
  std::optional<double> received_before_frame_end;
  int frames = 0;              ///< that have one before them
  int frames_overlapping = 0;  ///< that began projecting before the one before was composited
  double overlapping_us = 0;   ///< wall clock when a frame was projected and the one before composited
};

/// One run.
struct RunTime {
  std::string name;  ///< file
  TraceRun run;
  int ranks = 0;                ///< that the trace has spans of
  int frames = 0;               ///< rendered; times are divided by it to give those of a frame
  double elapsed_us = 0;        ///< wall clock while any process works on a frame
  std::vector<RoleTime> roles;  ///< projectors, compositors, processes that are both; those that there are
  Overlap overlap;
  std::optional<double> kilotets_per_second;  ///< tets of the mesh x frames / elapsed; none if the mesh is unknown

  [[nodiscard]] const RoleTime* role(TraceRole role) const;
};

RunTime break_down(const TraceFile& trace, const std::string& name);

/// Parallel efficiency as in Table 1: rate a processor core over that of the smallest run (fewest ranks x threads; the
/// first of several) of the same input and image size; none where the rate is unknown.
std::vector<std::optional<double>> efficiencies(std::span<const RunTime> runs);

}  // namespace tessera::analysis
