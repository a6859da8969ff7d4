#pragma once

#include "apps/render_options.hpp"

namespace tessera::apps {

/// `tessera info`: what a mesh file holds and how `render` would show it by default, on stdout, as text or as JSON.
/// Throws scene::Error.
void info(const std::filesystem::path& input, const io::MeshOptions& options, bool as_json);

}  // namespace tessera::apps
