// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tessera::api {

/// Whether a surface's name is that of a file and not of a block: by its extension, or because the file exists.
bool names_surface_file(const std::string& name);

}  // namespace tessera::api
