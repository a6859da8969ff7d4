#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tessera::scene {

/// One timed stretch of work. Times in microseconds; `start_us` counts from the trace's construction.
struct TraceSpan {
  const char* stage;  ///< string literal: read, prepare, cull, project, sort, integrate, composite, write, ...
  std::uint32_t thread;
  double start_us, wall_us, cpu_us;
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
  TraceScope(Trace* trace, const char* stage);
  ~TraceScope();
  TraceScope(const TraceScope&) = delete;
  TraceScope& operator=(const TraceScope&) = delete;

 private:
  Trace* trace_;
  const char* stage_;
  double start_us_ = 0, start_cpu_us_ = 0;
};

}  // namespace tessera::scene
