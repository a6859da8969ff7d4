// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tessera/trace_file.hpp"

/// How a traced run spent its time: the breakdown of Juliachs, Carrard, Nominé, "Hybrid CPU-GPU Unstructured Meshes
/// Parallel Volume Rendering on PC Clusters", 2007, section 5, Figure 9 and Table 1.
///
/// The *whole* of a process in a role is the wall clock time while at least one of its `frame` spans runs. Every
/// instant of the whole is attributed to stages:
///   - to the stages in which the process's threads are at that instant, in equal parts per thread;
///   - a thread is in the innermost of its spans;
///   - `wait` is only counted while no thread of the process does anything else;
///   - `other` is the time when no thread is in any stage.
/// The stages of a process therefore add up to its whole, and averages over processes add up to the average whole, as
/// in the paper. A stage that runs on one thread while the others are idle is attributed all of the clock time, which
/// is its cost. CPU time is the sum over the threads that recorded the stage. Time outside the frames (reading,
/// partition) is counted separately, in the same way.
///
/// If one rank has both roles, each role is counted as if it were alone: a span states for which role its thread
/// worked. Spans of such a rank without a role belong to the projector up to `project`, otherwise to the compositor.
/// The roles of a rank are those of its `frame` spans. Work for another role (reading parts of the mesh) is counted
/// with these roles.
namespace tessera::analysis {

/// A stage in the processes of one role. Times (in microseconds) and counts are for the whole run, not per frame.
struct StageTime {
  std::string stage;
  double average_us = 0;                  ///< attributed wall clock time, mean over processes
  double worst_us = 0;                    ///< largest attributed wall clock time of a process
  int worst_rank = 0;                     ///< the rank of that process
  double share = 0;                       ///< share of the average whole
  double cpu_us = 0;                      ///< CPU time, mean over processes
  double thread_us = 0;                   ///< time of all threads in the stage, sum over processes
  std::uint64_t bytes = 0, messages = 0;  ///< sum over processes
};

/// All processes of one role.
struct RoleTime {
  TraceRole role = TraceRole::both;
  int processes = 0;
  bool has_frames = true;          ///< false: the trace has no `frame` span; the total is then the time of all spans
  StageTime whole;                 ///< its CPU time and bytes are the sums over stages
  double busy_threads = 0;         ///< number of threads in a stage other than `wait`, mean over the whole
  std::vector<StageTime> stages;   ///< stages in frames, in the order of the pipeline, `other` last
  std::vector<StageTime> outside;  ///< stages outside frames; their share is 0

  /// The stage of this name in `stages`; null if no process was in it.
  [[nodiscard]] const StageTime* stage(const std::string& name) const;
  /// The largest share of waiting in the whole of a process, and the rank of that process.
  double worst_wait_share = 0;
  int worst_wait_rank = 0;
};

/// How much exchange and frames overlap with projection. Shares are relative to all bytes of frames. They are empty if
/// the trace does not contain such bytes or frame numbers.
struct Overlap {
  std::optional<double> sent_before_projected;      ///< share of bytes sent before the last projector finished its work
                                                    ///< on the frame
  std::optional<double> sent_before_frame_end;      ///< share of bytes sent before the last projector's `frame` span
                                                    ///< ended
  std::optional<double> received_before_projected;  ///< share of bytes that compositors received before the last
                                                    ///< projector finished its work
  std::optional<double> received_before_frame_end;
  int frames = 0;              ///< number of frames that have a previous frame
  int frames_overlapping = 0;  ///< number of frames whose projection began before the previous frame was composited
  double overlapping_us = 0;   ///< wall clock time in which a frame was projected while the previous frame was
                               ///< composited
};

/// The times of a run.
struct RunTime {
  std::string name;  ///< name of the file
  TraceRun run;
  int ranks = 0;                ///< number of ranks with spans in the trace
  int frames = 0;               ///< number of rendered frames; times divided by it are times per frame
  double elapsed_us = 0;        ///< wall clock time in which any process works on a frame
  std::vector<RoleTime> roles;  ///< projectors, compositors, processes with both roles; only existing ones
  Overlap overlap;
  std::optional<double> kilotets_per_second;  ///< tets of the mesh x frames / elapsed; none if the mesh is unknown

  [[nodiscard]] const RoleTime* role(TraceRole role) const;
};

RunTime break_down(const TraceFile& trace, const std::string& name);

/// Returns the parallel efficiencies, as in Table 1: the rate per processor core relative to that of the smallest run
/// with the same input and image size. The smallest run is the first one with the fewest ranks x threads. None if the
/// rate is unknown.
std::vector<std::optional<double>> efficiencies(std::span<const RunTime> runs);

}  // namespace tessera::analysis
