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

/// For whom a process worked. A rank may project and composite at once, and a projector composites its own runs, so
/// that the stage alone does not say it.
enum class TraceRole : std::uint8_t {
  both,       ///< one process that does everything
  projector,  ///< from the mesh to fragments that have left
  compositor  ///< from fragments that arrive to the finished picture
};

/// One timed stretch of work. Times in microseconds; `start_us` counts from the recording's beginning.
///
/// Stages, one word for a thing in every process:
///   read, partition                       once a mesh: from files, between processes
///   prepare, transform, cull, bin         once a mesh or frame, before projection
///   project, sort, integrate, composite   the pipeline, tile by tile
///   pack, send, receive                   exchange that moves: records written, bytes handed over and taken
///   wait                                  exchange that waits: for credit, for fragments, for a frame to leave
///   assemble, write, verify               the finished picture
///   frame                                 one frame of one role of one process, from its first work to its last; the
///                                         stages above lie inside it, but for what is done once a mesh
///
/// Spans of one thread nest (`integrate` inside `composite`): a span's own time is what no span inside it takes. Spans
/// of `frame` stand beside the threads, and those of several frames in flight may overlap. The time that a thread
/// sleeps for others belongs into `wait`, and nothing else does: not into `receive`, `send` or the work it waits for.
/// Where several threads share a loop, each records its part, inside the span of the thread that began the loop.
struct TraceSpan {
  const char* stage;     ///< string literal
  std::uint32_t thread;  ///< number of the thread, dense in a process
  double start_us, wall_us;
  double cpu_us;               ///< of this thread alone, even where other threads helped; to 1 us
  std::int32_t frame = -1;     ///< number in the run, -1 for work of no frame
  std::uint64_t bytes = 0;     ///< moved (pack, send, receive, assemble, read, write)
  std::uint32_t messages = 0;  ///< moved (send, receive, assemble)
  TraceRole role = TraceRole::both;
  std::int32_t tile = -1;  ///< that the work was for, -1: for no single one
  std::int32_t peer = -1;  ///< rank that a message went to or came from (send, receive, assemble), -1: none
};

/// Collects spans of all threads of a process. Give work a null pointer instead and timing costs nothing. Settings and
/// ReadOptions take one; tessera/trace_file.hpp writes it.
///
/// A recording may have several faces, one a role: `Trace projecting(TraceRole::projector)`,
/// `Trace compositing(projecting, TraceRole::compositor)`. Work that is handed one face need not know for whom it
/// works. They share clock, thread numbers and spans; the recording lives as long as its last face.
///
/// All member functions may be called from any thread. Each thread writes to a buffer of its own; a span costs about a
/// microsecond, most of it the system call for its CPU time, so time tiles and batches, not cells.
class TESSERA_EXPORT Trace {
 public:
  explicit Trace(TraceRole role = TraceRole::both);
  /// Another face of `other`'s recording.
  Trace(const Trace& other, TraceRole role);

  [[nodiscard]] TraceRole role() const { return role_; }
  /// The frame of this face's spans that name none, from now on; -1 for none.
  void set_frame(std::int32_t frame) { frame_.store(frame, std::memory_order_relaxed); }
  [[nodiscard]] std::int32_t frame() const { return frame_.load(std::memory_order_relaxed); }

  /// Adds a span as it stands, with its own role and frame.
  void add(const TraceSpan& span);
  /// Adds this face's `frame` span from `start_us` (of now_us()) to now: where no scope spans a frame.
  void add_frame(std::int32_t frame, double start_us);

  /// All spans of the recording, through whichever face they came; each thread's in the order of their ends.
  [[nodiscard]] std::vector<TraceSpan> spans() const;
  /// The same, which are gone from the recording then: for who looks at each frame of a run without end.
  std::vector<TraceSpan> take_spans();
  [[nodiscard]] double now_us() const;
  /// Small dense number of the calling thread, 0 for the first that asks.
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
  /// With what it moves known beforehand.
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
