// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "scene/trace.hpp"
#include "tessera/trace_file.hpp"

/// Chrome's trace-event JSON, which Perfetto and chrome://tracing open and `tessera timing` reads: one file for all
/// ranks and threads of a run. docs/FORMATS.md documents every field.
namespace tessera::io {

using tessera::TraceRun;

/// One rank's events as the text of a JSON array, which ranks can send to the rank that writes the file.
///
/// `process_name` is the role: `rank 3 projector`, `rank 0 projector + compositor`; the host's name is added as a
/// label. `offset_us` is added to this rank's times: rank 0's clock minus this one's. Includes all roles in the
/// recording.
std::string chrome_trace_events(const scene::Trace& trace, int rank, const std::string& process_name,
                                double offset_us = 0);

/// Writes the trace of a run from its ranks' events; an empty text represents a rank that sent none. The file appears
/// by rename. Throws like AtomicFile.
void write_chrome_trace(std::span<const std::string> events_of_ranks, const TraceRun& run,
                        const std::filesystem::path& file);

}  // namespace tessera::io
