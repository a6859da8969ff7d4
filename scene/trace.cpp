#include "scene/trace.hpp"

#include <ctime>

namespace tessera::scene {
namespace {

double thread_cpu_us() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e6 + static_cast<double>(t.tv_nsec) * 1e-3;
}

}  // namespace

void Trace::add(const TraceSpan& span) {
  const std::lock_guard lock(mutex_);
  spans_.push_back(span);
}

std::vector<TraceSpan> Trace::spans() const {
  const std::lock_guard lock(mutex_);
  return spans_;
}

double Trace::now_us() const {
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - origin_).count();
}

std::uint32_t Trace::thread_number() {
  const std::lock_guard lock(mutex_);
  const auto self = std::this_thread::get_id();
  for (std::size_t i = 0; i < threads_.size(); ++i)
    if (threads_[i] == self) return static_cast<std::uint32_t>(i);
  threads_.push_back(self);
  return static_cast<std::uint32_t>(threads_.size() - 1);
}

TraceScope::TraceScope(Trace* trace, const char* stage, std::int32_t frame)
    : trace_(trace), stage_(stage), frame_(frame) {
  if (trace_ == nullptr) return;
  start_us_ = trace_->now_us();
  start_cpu_us_ = thread_cpu_us();
}

TraceScope::~TraceScope() {
  if (trace_ == nullptr) return;
  trace_->add({stage_, trace_->thread_number(), start_us_, trace_->now_us() - start_us_,
               thread_cpu_us() - start_cpu_us_, frame_, bytes_, messages_});
}

}  // namespace tessera::scene
