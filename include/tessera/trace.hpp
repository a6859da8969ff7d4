// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "tessera/export.hpp"

namespace tessera::scene {
class StageTimer;
class TraceTile;
}  // namespace tessera::scene

namespace tessera {
inline namespace v0_1 {

/// The role in which a process did its work. The stage alone does not determine the role: a rank may project and
/// composite at the same time, and a projector composites its own runs.
enum class TraceRole : std::uint8_t {
  both,       ///< one process with both roles
  projector,  ///< works from the mesh to the sent fragments
  compositor  ///< works from the received fragments to the finished image
};

/// One timed interval of work. Times are in microseconds; `start_us` is measured from the beginning of the recording.
///
/// Stages, the same names in every process:
///   read, partition                       once per mesh: reading files, distribution to processes
///   prepare, transform, cull, bin         once per mesh or frame, before projection
///   project, sort, integrate, composite   the pipeline, tile by tile
///   pack, send, receive                   exchange, active: writing records, sending and receiving bytes
///   wait                                  exchange, waiting: for credit, for fragments, for a frame to be sent
///   assemble, write, verify               the finished image
///   frame                                 one frame of one role of one process, from the beginning to the end of its
///                                         work; it contains the stages above except those done once per mesh
///
/// Spans of one thread nest (`integrate` inside `composite`): a span's own time excludes the spans inside it. Spans of
/// `frame` do not belong to a thread, and those of several frames in flight may overlap. The stage `wait` contains
/// exactly the time that threads sleep while they wait for others; this time is not part of `receive`, `send` or the
/// work for which a thread waits. If several threads share a loop, each records its own part, inside the span of the
/// thread that started the loop.
struct TraceSpan {
  const char* stage;     ///< string literal
  std::uint32_t thread;  ///< number of the thread; numbers are consecutive in a process
  double start_us, wall_us;
  double cpu_us;               ///< CPU time of this thread alone, even if other threads helped; precise to 1 us
  std::int32_t frame = -1;     ///< number of the frame in the run; -1 for work that belongs to no frame
  std::uint64_t bytes = 0;     ///< bytes moved (pack, send, receive, assemble, read, write)
  std::uint32_t messages = 0;  ///< messages moved (send, receive, assemble)
  TraceRole role = TraceRole::both;
  std::int32_t tile = -1;  ///< tile for which the work was done; -1 if it was not done for a single tile
  std::int32_t peer = -1;  ///< rank that sent or received the message (send, receive, assemble); -1: none
};

/// Collects the spans of all threads of a process. Settings and ReadOptions have a pointer to a Trace; if the pointer
/// is null, timing costs nothing. The functions of tessera/trace_file.hpp write a Trace to a file.
///
/// A recording may have several Trace objects, one per role: `Trace projecting(TraceRole::projector)`, `Trace
/// compositing(projecting, TraceRole::compositor)`. Code that receives one of these objects need not know the role. The
/// objects share the clock, the thread numbers and the spans. The recording exists until the last of its objects is
/// destroyed.
///
/// All member functions may be called from any thread. Each thread writes to its own buffer; a span costs about a
/// microsecond, mostly for the system call that reads the CPU time. Callers should therefore time tiles and batches,
/// not cells.
class TESSERA_EXPORT Trace {
 public:
  explicit Trace(TraceRole role = TraceRole::both);
  /// Makes a Trace that adds to the recording of `other` in another role.
  Trace(const Trace& other, TraceRole role);

  [[nodiscard]] TraceRole role() const { return role_; }
  /// Sets the frame for this object's later spans whose frame is not specified; -1 for none.
  void set_frame(std::int32_t frame) { frame_.store(frame, std::memory_order_relaxed); }
  [[nodiscard]] std::int32_t frame() const { return frame_.load(std::memory_order_relaxed); }

  /// Adds a span unchanged, with the role and the frame that it contains.
  void add(const TraceSpan& span);
  /// Adds a span of the stage `frame`, with this object's role, from `start_us` (a value of now_us()) to now. For
  /// frames whose work is not within one TraceScope.
  void add_frame(std::int32_t frame, double start_us);

  /// All spans of the recording, of all roles. The spans of each thread are in the order of their ends.
  [[nodiscard]] std::vector<TraceSpan> spans() const;
  /// Returns all spans like spans() and removes them from the recording. For programs that process the spans of each
  /// frame of an endless run.
  std::vector<TraceSpan> take_spans();
  [[nodiscard]] double now_us() const;
  /// Consecutive number of the calling thread; 0 for the first thread that calls this function.
  std::uint32_t thread_number();

 private:
  struct ThreadSpans;
  struct Recording;
  friend class TraceScope;
  friend class scene::StageTimer;
  friend class scene::TraceTile;
  ThreadSpans& mine();

  std::shared_ptr<Recording> recording_;
  TraceRole role_;
  std::atomic<std::int32_t> frame_ = -1;
};

/// Records the time from its construction to its destruction; does nothing if `trace` is null.
class TESSERA_EXPORT TraceScope {
 public:
  TraceScope(Trace* trace, const char* stage, std::int32_t frame = -1) : trace_(trace) {
    if (trace_ != nullptr) begin(stage, frame);
  }
  /// For data whose amount is known in advance.
  TraceScope(Trace* trace, const char* stage, std::int32_t frame, std::uint64_t bytes, std::uint32_t messages,
             std::int32_t peer = -1)
      : TraceScope(trace, stage, frame) {
    moved(bytes, messages);
    peer_ = peer;
  }
  ~TraceScope() {
    if (trace_ != nullptr) end();
  }
  void moved(std::uint64_t bytes, std::uint32_t messages = 0) { bytes_ += bytes, messages_ += messages; }
  TraceScope(const TraceScope&) = delete;
  TraceScope& operator=(const TraceScope&) = delete;

 private:
  void begin(const char* stage, std::int32_t frame);
  void end();

  Trace* trace_;
  const char* stage_ = nullptr;
  std::int32_t frame_ = -1, peer_ = -1;
  std::uint32_t messages_ = 0;
  std::uint64_t bytes_ = 0;
  double start_us_ = 0, start_cpu_us_ = 0;
};

}  // namespace v0_1
}  // namespace tessera
