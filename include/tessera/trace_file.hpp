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

/// Trace files: JSON in Chrome's trace-event format, which Perfetto and chrome://tracing open and `tessera timing`
/// reads. One file contains all ranks and threads of a run. docs/FORMATS.md describes every field.
namespace tessera {
inline namespace v0_1 {

/// Metadata about a run, stored in the file's `otherData`. Empty texts and zeros are not written.
struct TraceRun {
  std::string version;                  ///< version of the program
  std::string input;                    ///< name of the mesh file as given by the user
  std::uint64_t tets = 0;               ///< number of tets of the whole mesh, all rendered for each frame
  int frames = 0;                       ///< number of rendered frames, including repetitions
  int width = 0, height = 0;            ///< pixels
  int ranks = 1;                        ///< processes
  int projectors = 0, compositors = 0;  ///< number of ranks with the role; both 0: one process has both roles
  int threads = 0;                      ///< per rank
  std::string exchange;                 ///< "segments" or "runs"
  std::string rasterizer, integrator;   ///< as named on the command line
  std::string commit{}, build{};        ///< commit and build of the program, as in tessera/version.hpp
  /// Ray segments of a mesh, or pixels of a grid, of all frames without repetitions; and how many of them were computed
  /// in double precision.
  std::uint64_t parts = 0, parts_in_double_precision = 0;
  bool operator==(const TraceRun&) const = default;
};

/// A span in a trace file. Times are in microseconds of rank 0's clock.
struct FileSpan {
  double start_us = 0, wall_us = 0, cpu_us = 0;
  std::uint64_t bytes = 0, messages = 0;
  std::uint32_t thread = 0;
  std::int32_t rank = 0;
  std::int32_t frame = -1;  ///< -1: the work belongs to no frame
  std::int32_t tile = -1;   ///< -1: the work was not done for a single tile
  std::int32_t peer = -1;   ///< rank to which or from which a message was sent; -1: none
  std::uint16_t stage = 0;  ///< index in TraceFile::stages
  TraceRole role = TraceRole::both;
};

/// The contents of a trace file.
struct TraceFile {
  TraceRun run;                     ///< members that the file does not contain are empty or 0
  std::vector<std::string> stages;  ///< each name once, in the order of the first span of each stage
  std::vector<FileSpan> spans;      ///< in the file's order
};

/// Writes the spans recorded by this process. The file appears by rename. Throws the same errors as write_image().
TESSERA_EXPORT void write_trace(const Trace& trace, const TraceRun& run, const std::filesystem::path& file);
/// Gathers the spans of all ranks on rank `writer`, aligns their clocks, and writes them on that rank. `process_name`
/// contains this rank's role: `rank 3 projector`, `rank 0 projector + compositor`. Collective.
TESSERA_EXPORT void write_trace(const Trace& trace, const std::string& process_name, const TraceRun& run,
                                const std::filesystem::path& file, const Communicator& communicator, int writer = 0);

/// Reads a file of write_trace(), even if the file was edited: events and fields of other programs are ignored, and an
/// array of events without the enclosing object is accepted. The file is parsed as a stream, without a tree in memory.
/// The result takes 64 bytes per span, half as much as the text.
///
/// Throws Error(bad_input) if the file is not JSON or is truncated, if one of Tessera's events has no valid time, or if
/// there is no span of Tessera.
TESSERA_EXPORT TraceFile read_trace(const std::filesystem::path& file);

}  // namespace v0_1
}  // namespace tessera
