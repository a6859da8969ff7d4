// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <semaphore>
#include <thread>
#include <vector>

#include "gl/context.hpp"
#include "scene/trace.hpp"

namespace tessera::gl {

/// The device's own times of stages of commands (timer queries), for the trace. Does nothing if `trace` is null.
///
/// A device works beside the thread that feeds it, so its spans are on a row of their own and count no CPU time.
class StageTimer {
 public:
  StageTimer(const Context& context, scene::Trace* trace);
  ~StageTimer();
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

  /// Commands that follow belong to no stage until the first record().
  void begin(std::int32_t frame);
  /// The commands since the last call were `stage`, a string literal, in so many passes over the lists: the trace has
  /// them as the messages that they are, to the device.
  void record(const char* stage, std::uint32_t passes = 0);
  /// Adds the spans to the trace; the device must be through with the commands.
  void collect();

 private:
  struct Stage {
    const char* stage;
    std::uint32_t passes;
  };
  void mark();

  const Context* context_;
  scene::Trace* trace_;
  std::thread row_thread_;
  std::binary_semaphore numbered_{0}, ended_{0};
  std::uint32_t row_ = 0;
  std::int32_t frame_ = -1;
  double offset_us_ = 0;  ///< device's clock to the trace's
  std::vector<GLuint> queries_;
  std::size_t used_ = 0;
  std::vector<Stage> recorded_;
};

}  // namespace tessera::gl
