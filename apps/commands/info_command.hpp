// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/program/render_options.hpp"

namespace tessera::apps {

/// `tessera info`: prints what a file contains and how `render` would show it by default, as text or as JSON. `first`
/// is first_input(). With `check`, for meshes, also prints defects of the cells (tessera/mesh_check.hpp). Shows the
/// progress of a slow read on stderr if that is a terminal. Throws Error.
void info(const std::filesystem::path& input, const InputFile& first, const ReadOptions& options, bool as_json,
          bool check);

}  // namespace tessera::apps
