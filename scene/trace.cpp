// SPDX-License-Identifier: BSD-3-Clause
#include "scene/trace.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <mutex>
#include <thread>
#include <unordered_map>
#include <utility>

namespace tessera {
inline namespace v0_1 {
namespace {

using Clock = std::chrono::steady_clock;

/// Within this time after a reading of its CPU clock, a thread is assumed to have run without interruption.
constexpr double adjacent_us = 1;

}  // namespace

struct Trace::ThreadSpans {
  /// Locked only by the thread itself, except briefly while spans() reads. Such a lock is cheaper than reading a clock.
  std::mutex mutex;
  std::vector<TraceSpan> spans;
  std::uint32_t number = 0;
  std::int32_t tile = -1;                     ///< the tile for which the thread works
  double wall_us = -adjacent_us, cpu_us = 0;  ///< time of the thread's last reading of its CPU clock, and the result

  /// Returns the thread's CPU time at `now_us`. Reading the CPU clock is an expensive system call (0.2 to 0.5 us). If
  /// one scope begins where another ends, or if a scope is empty, a single reading is used for both ends.
  double cpu_time(double now_us) {
    if (now_us - wall_us < adjacent_us) return cpu_us + (now_us - wall_us);
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    wall_us = now_us;
    cpu_us = static_cast<double>(t.tv_sec) * 1e6 + static_cast<double>(t.tv_nsec) * 1e-3;
    return cpu_us;
  }
};

struct Trace::Recording {
  Clock::time_point origin = Clock::now();
  std::mutex mutex;
  std::unordered_map<std::thread::id, ThreadSpans*> of_thread;
  std::vector<std::unique_ptr<ThreadSpans>> threads;  ///< indexed by the number of the thread
};

Trace::Trace(TraceRole role) : recording_(std::make_shared<Recording>()), role_(role) {}

Trace::Trace(const Trace& other, TraceRole role) : recording_(other.recording_), role_(role) {}

Trace::ThreadSpans& Trace::mine() {
  // The last buffer that this thread used. A later recording may have the address of an earlier recording, but not the
  // same time of its beginning.
  struct Last {
    const Recording* recording = nullptr;
    Clock::time_point origin;
    ThreadSpans* spans = nullptr;
  };
  thread_local Last last;
  if (last.recording == recording_.get() && last.origin == recording_->origin) return *last.spans;

  const std::lock_guard lock(recording_->mutex);
  ThreadSpans*& spans = recording_->of_thread[std::this_thread::get_id()];
  if (spans == nullptr) {
    recording_->threads.push_back(std::make_unique<ThreadSpans>());
    spans = recording_->threads.back().get();
    spans->number = static_cast<std::uint32_t>(recording_->threads.size() - 1);
  }
  last = {recording_.get(), recording_->origin, spans};
  return *spans;
}

void Trace::add(const TraceSpan& span) {
  ThreadSpans& spans = mine();
  const std::lock_guard lock(spans.mutex);
  spans.spans.push_back(span);
}

void Trace::add_frame(std::int32_t frame, double start_us) {
  add({"frame", thread_number(), start_us, now_us() - start_us, 0, frame, 0, 0, role_});
}

std::vector<TraceSpan> Trace::spans() const {
  std::vector<TraceSpan> all;
  const std::lock_guard lock(recording_->mutex);
  for (const auto& thread : recording_->threads) {
    const std::lock_guard spans_lock(thread->mutex);
    all.insert(all.end(), thread->spans.begin(), thread->spans.end());
  }
  return all;
}

std::vector<TraceSpan> Trace::take_spans() {
  std::vector<TraceSpan> all;
  const std::lock_guard lock(recording_->mutex);
  for (const auto& thread : recording_->threads) {
    const std::lock_guard spans_lock(thread->mutex);
    all.insert(all.end(), thread->spans.begin(), thread->spans.end());
    thread->spans.clear();
  }
  return all;
}

double Trace::now_us() const {
  return std::chrono::duration<double, std::micro>(Clock::now() - recording_->origin).count();
}

std::uint32_t Trace::thread_number() { return mine().number; }

void TraceScope::begin(const char* stage, std::int32_t frame) {
  stage_ = stage;
  frame_ = frame >= 0 ? frame : trace_->frame();
  start_us_ = trace_->now_us();
  start_cpu_us_ = trace_->mine().cpu_time(start_us_);
}

void TraceScope::end() {
  const double end_us = trace_->now_us();
  Trace::ThreadSpans& mine = trace_->mine();
  // A CPU time that was extrapolated from an adjacent reading may be slightly larger than the CPU clock.
  const double cpu_us = std::max(0.0, mine.cpu_time(end_us) - start_cpu_us_);
  const TraceSpan span{stage_, mine.number, start_us_,      end_us - start_us_, cpu_us, frame_,
                       bytes_, messages_,   trace_->role(), mine.tile,          peer_};
  const std::lock_guard lock(mine.mutex);
  mine.spans.push_back(span);
}

}  // namespace v0_1

namespace scene {

namespace {

std::uint64_t processor_ticks() {
#if defined(__x86_64__)
  return __builtin_ia32_rdtsc();
#else
  return static_cast<std::uint64_t>(Clock::now().time_since_epoch().count());
#endif
}

}  // namespace

void StageTimer::begin() {
  start_us_ = trace_->now_us();
  start_cpu_us_ = trace_->mine().cpu_time(start_us_);
  last_ = processor_ticks();
}

void StageTimer::add(const char* stage) {
  const std::uint64_t now = processor_ticks(), ticks = now - last_;
  last_ = now;
  for (std::size_t i = 0; i < stages_; ++i)
    if (sums_[i].stage == stage) {
      sums_[i].ticks += ticks;
      return;
    }
  if (stages_ < sums_.size()) sums_[stages_++] = {stage, ticks};
}

void StageTimer::end() {
  const double wall_us = trace_->now_us() - start_us_;
  const double cpu_us = std::max(0.0, trace_->mine().cpu_time(start_us_ + wall_us) - start_cpu_us_);
  double all = 0, at_us = start_us_;
  for (const Sum& sum : sums_) all += static_cast<double>(sum.ticks);
  for (std::size_t i = 0; i < stages_ && all > 0; ++i) {
    const double share = static_cast<double>(sums_[i].ticks) / all;
    trace_->add({sums_[i].stage, trace_->mine().number, at_us, wall_us * share, cpu_us * share, trace_->frame(), 0, 0,
                 trace_->role(), trace_->mine().tile});
    at_us += wall_us * share;
  }
}

void TraceTile::begin(std::int32_t tile) { before_ = std::exchange(trace_->mine().tile, tile); }

void TraceTile::end() { trace_->mine().tile = before_; }

}  // namespace scene
}  // namespace tessera
