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

/// The role for which a process worked. A rank may project and composite at once, and a projector composites its own
/// runs, so the stage alone does not determine it.
enum class TraceRole : std::uint8_t {
  both,       ///< one process that does everything
  projector,  ///< from the mesh to fragments that were sent
  compositor  ///< from received fragments to the finished image
};

/// One timed interval of work. Times in microseconds; `start_us` counts from the beginning of the recording.
///
/// Stages, the same names in every process:
///   read, partition                       once per mesh: from files, between processes
///   prepare, transform, cull, bin         once per mesh or frame, before projection
///   project, sort, integrate, composite   the pipeline, tile by tile
///   pack, send, receive                   exchange, active: writing records, passing bytes on and taking them
///   wait                                  exchange, waiting: for credit, for fragments, for a frame to leave
///   assemble, write, verify               the finished image
///   frame                                 one frame of one role of one process, from the beginning to the end of its
///                                         work; it contains the stages above except those done once per mesh
///
/// Spans of one thread nest (`integrate` inside `composite`): a span's own time excludes the spans inside it. Spans of
/// `frame` do not belong to a thread, and those of several frames in flight may overlap. All time that a thread sleeps
/// waiting for others belongs to `wait`, and nothing else does; it is not part of `receive`, `send` or the work it
/// waits for. If several threads share a loop, each records its part, inside the span of the thread that started the
/// loop.
struct TraceSpan {
  const char* stage;     ///< string literal
  std::uint32_t thread;  ///< number of the thread, consecutive in a process
  double start_us, wall_us;
  double cpu_us;               ///< of this thread alone, even if other threads helped; to 1 us
  std::int32_t frame = -1;     ///< number in the run, -1 for work that belongs to no frame
  std::uint64_t bytes = 0;     ///< moved (pack, send, receive, assemble, read, write)
  std::uint32_t messages = 0;  ///< moved (send, receive, assemble)
  TraceRole role = TraceRole::both;
  std::int32_t tile = -1;  ///< for which the work was done, -1: no single one
  std::int32_t peer = -1;  ///< rank that sent or received the message (send, receive, assemble), -1: none
};

/// Collects spans of all threads of a process. With a null pointer instead, timing costs nothing. Settings and
/// ReadOptions take one; tessera/trace_file.hpp writes it.
///
/// A recording may have several Trace objects, one per role: `Trace projecting(TraceRole::projector)`, `Trace
/// compositing(projecting, TraceRole::compositor)`. Work that is given one of them need not know its role. They share
/// clock, thread numbers and spans; the recording lives as long as the last of them.
///
/// All member functions may be called from any thread. Each thread writes to its own buffer; a span costs about a
/// microsecond, mostly for the system call that reads its CPU time, so time tiles and batches, not cells.
class TESSERA_EXPORT Trace {
 public:
  explicit Trace(TraceRole role = TraceRole::both);
  /// Another role of `other`'s recording.
  Trace(const Trace& other, TraceRole role);

  [[nodiscard]] TraceRole role() const { return role_; }
  /// Sets the frame of this object's later spans that do not name one; -1 for none.
  void set_frame(std::int32_t frame) { frame_.store(frame, std::memory_order_relaxed); }
  [[nodiscard]] std::int32_t frame() const { return frame_.load(std::memory_order_relaxed); }

  /// Adds a span unchanged, with its own role and frame.
  void add(const TraceSpan& span);
  /// Adds a `frame` span with this role from `start_us` (as now_us()) to now: for a frame that no scope covers.
  void add_frame(std::int32_t frame, double start_us);

  /// All spans of the recording, of all roles; those of each thread in the order of their ends.
  [[nodiscard]] std::vector<TraceSpan> spans() const;
  /// The same, but removes them from the recording: for programs that consume each frame of an endless run.
  std::vector<TraceSpan> take_spans();
  [[nodiscard]] double now_us() const;
  /// Small consecutive number of the calling thread, 0 for the first that calls this.
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
  /// With the amount of data known in advance.
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
