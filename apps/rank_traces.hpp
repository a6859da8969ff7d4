#pragma once

#include <filesystem>
#include <string>

#include "exchange/transport.hpp"
#include "io/chrome_trace.hpp"
#include "scene/trace.hpp"

namespace tessera::apps {

/// Gathers all ranks' spans on rank `writer` and writes them there, their clocks aligned. Collective.
void write_rank_traces(exchange::Transport& transport, int writer, const scene::Trace& trace,
                       const std::string& process_name, const io::TraceRun& run, const std::filesystem::path& file);

}  // namespace tessera::apps
