#pragma once

#include "apps/render_options.hpp"
#include "exchange/transport.hpp"
#include "scene/error.hpp"

namespace tessera::apps {

/// `tessera render` of a regular grid on all ranks of the job, one or more: view, transfer function, pictures, times,
/// report and verification as for meshes; the picture is split between ranks (frame/sort_first.hpp), rank 0 writes and
/// speaks. Collective. Throws scene::Error, also for options that are for meshes only.
scene::ExitCode render_volume(const RenderOptions& options, exchange::Transport& transport);

}  // namespace tessera::apps
