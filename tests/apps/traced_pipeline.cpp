// SPDX-License-Identifier: BSD-3-Clause
#include "apps/traced_pipeline.hpp"

#include <vector>

#include "io/scene/chrome_trace.hpp"

namespace tessera::apps {
namespace {

using scene::Trace;
using scene::TraceRole;

constexpr double clock_ms = 1e6;  // difference between the clocks of consecutive ranks

/// One thread's spans, in sequence.
class Thread {
 public:
  Thread(Trace& trace, std::uint32_t number, int frame, double begin_ms)
      : trace_(&trace), number_(number), frame_(frame), now_(begin_ms) {}
  Thread& span(const char* stage, double ms, double cpu_ms, std::uint64_t bytes = 0, std::uint32_t messages = 0) {
    inner(stage, now_, ms, cpu_ms, bytes, messages);
    now_ += ms;
    return *this;
  }
  void inner(const char* stage, double begin_ms, double ms, double cpu_ms, std::uint64_t bytes = 0,
             std::uint32_t messages = 0) {
    trace_->add({stage, number_, begin_ms * 1e3, ms * 1e3, cpu_ms * 1e3, frame_, bytes, messages, trace_->role()});
  }
  [[nodiscard]] double now() const { return now_; }

 private:
  Trace* trace_;
  std::uint32_t number_;
  int frame_;
  double now_;
};

void project_frame(Trace& trace, int frame, double begin, double frame_ms) {
  for (std::uint32_t number = 0; number < 2; ++number) {
    Thread thread(trace, number, frame, begin + (number == 0 ? 0 : 10));
    if (number == 0) thread.span("transform", 10, 10);
    thread.span("project", 40, 38).span("sort", 10, 10);
    thread.inner("integrate", thread.now() + 2, 15, 15);
    thread.span("composite", 20, 20).span("pack", 4, 4).span("send", 6, 1, 1000, 2);
    if (begin + frame_ms > thread.now()) thread.span("wait", begin + frame_ms - thread.now(), 0);
  }
  trace.add({"frame", 0, begin * 1e3, frame_ms * 1e3, 0, frame, 0, 0, trace.role()});
}

void composite(Trace& trace, int frame, double begin, double frame_ms, std::uint64_t bytes, bool first) {
  Thread thread(trace, 2, frame, begin);
  thread.span("receive", 10, 5, bytes, 4).span("wait", 60, 0).span("sort", 5, 5).span("composite", 10, 10);
  if (first) thread.span("assemble", 5, 5).span("write", 5, 1, 12345);
  trace.add({"frame", 2, begin * 1e3, frame_ms * 1e3, 0, frame, 0, 0, trace.role()});
}

}  // namespace

void TracedPipeline::write(const std::filesystem::path& file) const {
  const int ranks = shared ? std::max(projectors, compositors) : projectors + compositors;
  std::vector<std::string> events;
  for (int rank = 0; rank < ranks; ++rank) {
    Trace projecting(TraceRole::projector);
    Trace compositing(projecting, TraceRole::compositor);
    const int compositor = shared ? rank : rank - projectors;
    const double lag = rank * clock_ms;
    projecting.add({"read", 0, (1000 - lag) * 1e3, (200 + 100 * rank) * 1e3, 5e4, -1, 5000, 0,
                    rank < projectors ? TraceRole::projector : TraceRole::compositor});
    for (int frame = 0; frame < frames; ++frame) {
      const double begin = 2000 + every_ms * frame - lag;
      if (rank < projectors) project_frame(projecting, frame, begin, frame_ms);
      if (compositor >= 0 && compositor < compositors)
        composite(compositing, frame, begin + compositors_begin_ms, frame_ms,
                  static_cast<std::uint64_t>(2000 * projectors / compositors), compositor == 0);
    }
    events.push_back(io::chrome_trace_events(projecting, rank, "rank " + std::to_string(rank), lag * 1e3));
  }
  io::write_chrome_trace(
      events, {"0.0.0", "mesh.vtu", tets, frames, 64, 32, ranks, projectors, compositors, 2, "runs", "planes", "exact"},
      file);
}

}  // namespace tessera::apps
