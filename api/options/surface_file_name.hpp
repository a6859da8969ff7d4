// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tessera::api {

/// Whether a surface's name is a file's rather than a block's: by its extension, or since the file is there.
bool names_surface_file(const std::string& name);

}  // namespace tessera::api
