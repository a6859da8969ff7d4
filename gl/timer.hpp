// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <semaphore>
#include <thread>
#include <vector>

#include "gl/context.hpp"
#include "scene/trace.hpp"

namespace tessera::gl {

/// Measures device times of stages of commands by timer queries, for the trace. Does nothing if `trace` is null.
///
/// A device works in parallel with the thread that sends its commands, so the device's spans have a row of their own
/// and do not count CPU time.
class StageTimer {
 public:
  StageTimer(const Context& context, scene::Trace* trace);
  ~StageTimer();
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

  /// Begins a frame. Commands before the first record() do not belong to any stage.
  void begin(std::int32_t frame);
  /// Attributes the commands since the last call to `stage`, a string literal. The stage made `passes` passes over the
  /// lists, which the trace records as messages to the device.
  void record(const char* stage, std::uint32_t passes = 0);
  /// Adds the spans to the trace. The device must have finished the commands.
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
  double offset_us_ = 0;  ///< the trace's clock minus the device's clock
  std::vector<GLuint> queries_;
  std::size_t used_ = 0;
  std::vector<Stage> recorded_;
};

}  // namespace tessera::gl
