#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/chrome_trace.hpp"

namespace tessera::io {

/// A span as a trace file has it. Times in microseconds on rank 0's clock.
struct FileSpan {
  double start_us = 0, wall_us = 0, cpu_us = 0;
  std::uint64_t bytes = 0, messages = 0;
  std::uint32_t thread = 0;
  std::int32_t rank = 0;
  std::int32_t frame = -1;  ///< -1: of no frame
  std::uint16_t stage = 0;  ///< place in TraceFile::stages
  scene::TraceRole role = scene::TraceRole::both;
};

/// What a trace file says of a run.
struct TraceFile {
  TraceRun run;                     ///< what the file leaves out is empty or 0
  std::vector<std::string> stages;  ///< each word once, in the order of its first span
  std::vector<FileSpan> spans;      ///< in the file's order
};

/// Reads what write_chrome_trace wrote, also when edited: other programs' events and fields are passed over, a bare
/// array of events will do. Takes the file as it streams by: 64 bytes a span, half of its text, and no tree.
///
/// Throws Error(bad_input): not JSON, or cut off; an event of ours without time or with a time that is none; not one
/// span of ours in it.
TraceFile parse_chrome_trace(std::string_view text, const std::string& source);
TraceFile read_chrome_trace(const std::filesystem::path& file);

}  // namespace tessera::io
