#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tessera::scene {

/// One timed stretch of work. Times in microseconds; `start_us` counts from the trace's construction.
///
/// Stages, one word for a thing in every process:
///   read, partition                       once a mesh: from files, between processes
///   prepare, transform, cull, bin         once a mesh or frame, before projection
///   project, sort, integrate, composite   the pipeline, tile by tile
///   pack, send, receive                   exchange that moves: records written, bytes handed over and taken
///   wait                                  exchange that waits: for credit, for fragments, for a frame to leave
///   assemble, write, verify               the finished picture
///   frame                                 the whole of one frame on one process; the stages above lie inside it
struct TraceSpan {
  const char* stage;  ///< string literal
  std::uint32_t thread;
  double start_us, wall_us, cpu_us;
  std::int32_t frame = -1;     ///< number in the run, -1 for work of no frame
  std::uint64_t bytes = 0;     ///< moved (pack, send, receive, read, write)
  std::uint32_t messages = 0;  ///< moved (send, receive)
};

/// Collects spans of all threads of a process. Give work a null pointer instead and timing costs nothing.
class Trace {
 public:
  Trace() : origin_(std::chrono::steady_clock::now()) {}
  void add(const TraceSpan& span);
  [[nodiscard]] std::vector<TraceSpan> spans() const;
  [[nodiscard]] double now_us() const;
  /// Small dense number of the calling thread, 0 for the first that asks.
  std::uint32_t thread_number();

 private:
  std::chrono::steady_clock::time_point origin_;
  mutable std::mutex mutex_;
  std::vector<TraceSpan> spans_;
  std::vector<std::thread::id> threads_;
};

/// Records the time from its construction to its destruction; does nothing if `trace` is null.
class TraceScope {
 public:
  TraceScope(Trace* trace, const char* stage, std::int32_t frame = -1);
  ~TraceScope();
  void moved(std::uint64_t bytes, std::uint32_t messages = 0) { bytes_ += bytes, messages_ += messages; }
  TraceScope(const TraceScope&) = delete;
  TraceScope& operator=(const TraceScope&) = delete;

 private:
  Trace* trace_;
  const char* stage_;
  std::int32_t frame_;
  std::uint64_t bytes_ = 0;
  std::uint32_t messages_ = 0;
  double start_us_ = 0, start_cpu_us_ = 0;
};

}  // namespace tessera::scene
