#pragma once

#include "apps/render_options.hpp"
#include "exchange/transport.hpp"
#include "scene/error.hpp"

namespace tessera::apps {

/// `tessera render`, of a mesh or a grid: plan the frames, check all outputs, read, render, write, verify, report; on
/// all ranks of the transport, or in this process if it is the only one. The rank that assembles the pictures writes
/// and speaks. Collective.
///
/// complete, or accuracy_not_met where --verify found more error than promised (the pictures are written then too).
/// Throws scene::Error.
scene::ExitCode render(const RenderOptions& options, exchange::Transport& transport);

}  // namespace tessera::apps
