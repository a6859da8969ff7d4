#pragma once

#include <filesystem>
#include <string>

#include "scene/trace.hpp"

namespace tessera::io {

/// The trace as Chrome's trace-event JSON, which Perfetto opens: `{"traceEvents": [...]}` with one complete event
/// (`ph` X) a span: `name` the stage, `pid` the rank, `tid` the thread, `ts` and `dur` in microseconds of wall time,
/// `args.cpu_us` the thread's CPU time; and metadata events (`ph` M) that name process and threads.
std::string chrome_trace_json(const scene::Trace& trace, int rank, const std::string& process_name);

/// Writes it to a file, which appears by rename. Throws as AtomicFile does.
void write_chrome_trace(const scene::Trace& trace, const std::filesystem::path& file, int rank,
                        const std::string& process_name);

}  // namespace tessera::io
