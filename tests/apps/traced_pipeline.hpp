// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tessera::apps {

/// A fictitious run, with times that can be summed mentally: N projectors and P compositors of two threads, on N + P
/// ranks or sharing the first ones. Times in milliseconds; a frame takes `frame_ms` of every process, and each begins
/// `every_ms` after the previous one.
///
/// Projector, both threads: transform 10 (only thread 0), project 40, sort 10, composite 20 (integrate 15 of it), pack
/// 4, send 6 (1000 bytes in 2 messages a thread); wait for the rest of the frame. Compositor, thread 0: receive 10 (all
/// the projectors' bytes, evenly), wait 60, sort 5, composite 10; the first one assembles 5 and writes 5; then nothing.
/// Each rank's clock starts 1000 s after the previous one's; the trace converts them to rank 0's.
struct TracedPipeline {
  int projectors = 2, compositors = 1;
  bool shared = false;
  int frames = 3;
  double frame_ms = 100, every_ms = 100;
  double compositors_begin_ms = 50;  ///< after the projectors
  std::uint64_t tets = 1'000'000;

  void write(const std::filesystem::path& file) const;
};

}  // namespace tessera::apps
