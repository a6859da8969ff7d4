// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tessera/trace.hpp"

namespace tessera::scene {

using tessera::Trace;
using tessera::TraceRole;
using tessera::TraceScope;
using tessera::TraceSpan;

/// Measures the times of stages that alternate every sixteen cells or pixels, too quickly to use a scope for each. The
/// timer reads the processor's own counter, which takes about ten nanoseconds. At the end, one span is recorded for
/// each stage, with its share of the time; these spans follow one another. Does nothing if `trace` is null.
class StageTimer {
 public:
  explicit StageTimer(Trace* trace) : trace_(trace) {
    if (trace_ != nullptr) begin();
  }
  ~StageTimer() {
    if (trace_ != nullptr) end();
  }
  /// Adds the time since the last call, or since the beginning, to `stage`. `stage` must be a string literal; there may
  /// be at most six different stages.
  void record(const char* stage) {
    if (trace_ != nullptr) add(stage);
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  void begin();
  void add(const char* stage);
  void end();

  struct Sum {
    const char* stage;
    std::uint64_t ticks;
  };
  Trace* trace_;
  std::array<Sum, 6> sums_{};
  std::size_t stages_ = 0;
  std::uint64_t last_ = 0;
  double start_us_ = 0, start_cpu_us_ = 0;
};

/// While an object of this class exists, spans of any role that end on its thread belong to its tile. Does nothing if
/// `trace` is null.
class TraceTile {
 public:
  TraceTile(Trace* trace, std::size_t tile) : trace_(trace) {
    if (trace_ != nullptr) begin(static_cast<std::int32_t>(tile));
  }
  ~TraceTile() {
    if (trace_ != nullptr) end();
  }
  TraceTile(const TraceTile&) = delete;
  TraceTile& operator=(const TraceTile&) = delete;

 private:
  void begin(std::int32_t tile);
  void end();

  Trace* trace_;
  std::int32_t before_ = -1;
};

}  // namespace tessera::scene
