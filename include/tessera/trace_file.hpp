// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/communicator.hpp"
#include "tessera/export.hpp"
#include "tessera/trace.hpp"

/// Traces as files: Chrome's trace-event JSON, which Perfetto and chrome://tracing open and `tessera timing` reads, one
/// file for all ranks and threads of a run. docs/FORMATS.md has every field.
namespace tessera {
inline namespace v0_1 {

/// What was run, for readers of its trace: the file's `otherData`. Words left empty and numbers left 0 are not written.
struct TraceRun {
  std::string version;                  ///< of the program
  std::string input;                    ///< mesh file as it was named
  std::uint64_t tets = 0;               ///< of the whole mesh, rendered a frame
  int frames = 0;                       ///< rendered, repetitions counted
  int width = 0, height = 0;            ///< pixels
  int ranks = 1;                        ///< processes
  int projectors = 0, compositors = 0;  ///< ranks that have the role; 0 and 0: one process does both
  int threads = 0;                      ///< a rank
  std::string exchange;                 ///< segments, runs
  std::string rasterizer, integrator;   ///< as the command line names them
  std::string commit{}, build{};        ///< of the program: tessera/version.hpp
  bool operator==(const TraceRun&) const = default;
};

/// A span as a trace file has it. Times in microseconds on rank 0's clock.
struct FileSpan {
  double start_us = 0, wall_us = 0, cpu_us = 0;
  std::uint64_t bytes = 0, messages = 0;
  std::uint32_t thread = 0;
  std::int32_t rank = 0;
  std::int32_t frame = -1;  ///< -1: of no frame
  std::int32_t tile = -1;   ///< -1: of no single tile
  std::int32_t peer = -1;   ///< rank at the other end of a message, -1: none
  std::uint16_t stage = 0;  ///< place in TraceFile::stages
  TraceRole role = TraceRole::both;
};

/// What a trace file says of a run.
struct TraceFile {
  TraceRun run;                     ///< what the file leaves out is empty or 0
  std::vector<std::string> stages;  ///< each word once, in the order of its first span
  std::vector<FileSpan> spans;      ///< in the file's order
};

/// Writes what this process recorded. Appears by rename. Throws as write_image.
TESSERA_EXPORT void write_trace(const Trace& trace, const TraceRun& run, const std::filesystem::path& file);
/// Gathers all ranks' spans on rank `writer`, their clocks aligned, and writes them there. `process_name` says this
/// rank's role: `rank 3 projector`, `rank 0 projector + compositor`. Collective.
TESSERA_EXPORT void write_trace(const Trace& trace, const std::string& process_name, const TraceRun& run,
                                const std::filesystem::path& file, const Communicator& communicator, int writer = 0);

/// Reads what write_trace() wrote, also when edited: other programs' events and fields are passed over, a bare array of
/// events will do. Takes the file as it streams by: 64 bytes a span, half of its text, and no tree.
///
/// Throws Error(bad_input): not JSON, or cut off; an event of ours without time or with a time that is none; not one
/// span of ours in it.
TESSERA_EXPORT TraceFile read_trace(const std::filesystem::path& file);

}  // namespace v0_1
}  // namespace tessera
