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

/// Converts the events of one rank to the text of a JSON array, which ranks can send to the rank that writes the file.
///
/// `process_name` describes the rank's roles: `rank 3 projector`, `rank 0 projector + compositor`; the name of the host
/// is added as a label. `offset_us` is added to this rank's times: rank 0's clock minus this rank's clock. The text
/// contains the events of all roles in the recording.
std::string chrome_trace_events(const scene::Trace& trace, int rank, const std::string& process_name,
                                double offset_us = 0);

/// Writes the trace of a run from the events of its ranks. An empty text represents a rank that sent no events. The
/// file appears by rename. Throws like AtomicFile.
void write_chrome_trace(std::span<const std::string> events_of_ranks, const TraceRun& run,
                        const std::filesystem::path& file);

}  // namespace tessera::io
