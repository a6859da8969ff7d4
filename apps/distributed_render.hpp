#pragma once

#include <vector>

#include "apps/render_options.hpp"
#include "exchange/transport.hpp"
#include "io/chrome_trace.hpp"
#include "scene/error.hpp"

namespace tessera::apps {

/// `tessera render` on several ranks: each reads and projects its part of the mesh; the first compositor writes
/// pictures, report and trace, and prints. All ranks call it with the same arguments. As render() otherwise.
scene::ExitCode render_on_ranks(const RenderOptions& options, exchange::Transport& transport);

/// Gathers all ranks' spans on rank `writer` and writes them there, their clocks aligned. Collective.
void write_rank_traces(exchange::Transport& transport, int writer, const scene::Trace& trace,
                       const std::string& process_name, const io::TraceRun& run, const std::filesystem::path& file);

}  // namespace tessera::apps
