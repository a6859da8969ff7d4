// SPDX-License-Identifier: BSD-3-Clause
#include "gl/timer.hpp"

#include <algorithm>

#include "scene/start_thread.hpp"

namespace tessera::gl {

StageTimer::StageTimer(const Context& context, scene::Trace* trace) : context_(&context), trace_(trace) {
  if (trace_ == nullptr) return;
  // The rows of the trace are threads, so the device needs the number of a thread that does nothing else. That thread
  // lives as long as the timer, because the number of an ended thread may be reused.
  row_thread_ = scene::start_thread([this] {
    row_ = trace_->thread_number();
    numbered_.release();
    ended_.acquire();
  });
  numbered_.acquire();
}

StageTimer::~StageTimer() {
  if (row_thread_.joinable()) {
    ended_.release();
    row_thread_.join();
  }
  if (!queries_.empty()) context_->gl().DeleteQueries(static_cast<GLsizei>(queries_.size()), queries_.data());
}

void StageTimer::mark() {
  const Functions& gl = context_->gl();
  if (used_ == queries_.size()) {
    queries_.push_back(0);
    gl.CreateQueries(GL_TIMESTAMP, 1, &queries_.back());
  }
  gl.QueryCounter(queries_[used_++], GL_TIMESTAMP);
}

void StageTimer::begin(std::int32_t frame) {
  if (trace_ == nullptr) return;
  frame_ = frame;
  used_ = 0;
  recorded_.clear();
  GLint64 now = 0;
  context_->gl().GetInteger64v(GL_TIMESTAMP, &now);
  offset_us_ = trace_->now_us() - 1e-3 * static_cast<double>(now);
  mark();
}

void StageTimer::record(const char* stage, std::uint32_t passes) {
  if (trace_ == nullptr) return;
  recorded_.push_back({stage, passes});
  mark();
}

void StageTimer::collect() {
  if (trace_ == nullptr) return;
  GLuint64 last = 0;
  for (std::size_t i = 0; i < used_; ++i) {
    GLuint64 now = 0;
    context_->gl().GetQueryObjectui64v(queries_[i], GL_QUERY_RESULT, &now);
    if (i > 0) {
      scene::TraceSpan span{};
      span.stage = recorded_[i - 1].stage;
      span.thread = row_;
      span.start_us = 1e-3 * static_cast<double>(last) + offset_us_;
      span.wall_us = 1e-3 * static_cast<double>(std::max(now, last) - last);
      span.frame = frame_;
      span.messages = recorded_[i - 1].passes;
      span.role = trace_->role();
      trace_->add(span);
    }
    last = std::max(now, last);
  }
  used_ = 0;
  recorded_.clear();
}

}  // namespace tessera::gl
