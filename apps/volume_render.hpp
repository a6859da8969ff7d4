#pragma once

#include "apps/render_options.hpp"
#include "scene/error.hpp"

namespace tessera::apps {

/// `tessera render` of a regular or rectilinear grid, in one process with threads: view, transfer function, pictures,
/// times, report and verification as for meshes. Throws scene::Error, also for options that are for meshes only.
scene::ExitCode render_volume(const RenderOptions& options);

}  // namespace tessera::apps
