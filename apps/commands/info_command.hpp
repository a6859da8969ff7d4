// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/program/render_options.hpp"

namespace tessera::apps {

/// Implements `tessera info`: prints the contents of a file and how `render` would show them by default, as text or as
/// JSON. `first` is the result of first_input(). For meshes, `check` also prints defects of the cells
/// (tessera/mesh_check.hpp). If stderr is a terminal, the progress of slow reading is shown on it. Throws Error.
void info(const std::filesystem::path& input, const InputFile& first, const ReadOptions& options, bool as_json,
          bool check);

}  // namespace tessera::apps
