#pragma once

#include "apps/render_options.hpp"

namespace tessera::apps {

/// `tessera info`: what a mesh file holds and how `render` would show it by default, on stdout, as text or as JSON.
/// `check`: also what is wrong with its cells (scene/mesh_check.hpp). Throws scene::Error.
void info(const std::filesystem::path& input, const io::MeshOptions& options, bool as_json, bool check);

}  // namespace tessera::apps
