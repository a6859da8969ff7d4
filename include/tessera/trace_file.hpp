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
/// file for all ranks and threads of a run. docs/FORMATS.md describes every field.
namespace tessera {
inline namespace v0_1 {

/// Metadata about a run, stored in the file's `otherData`. Empty texts and zeros are not written.
struct TraceRun {
  std::string version;                  ///< of the program
  std::string input;                    ///< mesh file as named by the user
  std::uint64_t tets = 0;               ///< of the whole mesh, rendered per frame
  int frames = 0;                       ///< rendered, including repetitions
  int width = 0, height = 0;            ///< pixels
  int ranks = 1;                        ///< processes
  int projectors = 0, compositors = 0;  ///< ranks with the role; 0 and 0: one process does both
  int threads = 0;                      ///< per rank
  std::string exchange;                 ///< segments, runs
  std::string rasterizer, integrator;   ///< as named on the command line
  std::string commit{}, build{};        ///< of the program: tessera/version.hpp
  bool operator==(const TraceRun&) const = default;
};

/// A span in a trace file. Times in microseconds on rank 0's clock.
struct FileSpan {
  double start_us = 0, wall_us = 0, cpu_us = 0;
  std::uint64_t bytes = 0, messages = 0;
  std::uint32_t thread = 0;
  std::int32_t rank = 0;
  std::int32_t frame = -1;  ///< -1: belongs to no frame
  std::int32_t tile = -1;   ///< -1: no single tile
  std::int32_t peer = -1;   ///< rank at the other end of a message, -1: none
  std::uint16_t stage = 0;  ///< index in TraceFile::stages
  TraceRole role = TraceRole::both;
};

/// The contents of a trace file.
struct TraceFile {
  TraceRun run;                     ///< what the file omits is empty or 0
  std::vector<std::string> stages;  ///< each name once, in the order of its first span
  std::vector<FileSpan> spans;      ///< in the file's order
};

/// Writes what this process recorded. The file appears by rename. Throws as write_image.
TESSERA_EXPORT void write_trace(const Trace& trace, const TraceRun& run, const std::filesystem::path& file);
/// Gathers all ranks' spans on rank `writer`, aligns their clocks, and writes them there. `process_name` is this rank's
/// role: `rank 3 projector`, `rank 0 projector + compositor`. Collective.
TESSERA_EXPORT void write_trace(const Trace& trace, const std::string& process_name, const TraceRun& run,
                                const std::filesystem::path& file, const Communicator& communicator, int writer = 0);

/// Reads what write_trace() wrote, even if it was edited: events and fields of other programs are ignored, and a bare
/// array of events is accepted. Parses the file as a stream, without a tree: 64 bytes per span, half of its text.
///
/// Throws Error(bad_input): not JSON, or truncated; an event of ours without a valid time; no span of ours.
TESSERA_EXPORT TraceFile read_trace(const std::filesystem::path& file);

}  // namespace v0_1
}  // namespace tessera
