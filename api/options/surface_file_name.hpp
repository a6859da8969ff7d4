// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tessera::api {

/// Whether the name of a surface denotes a file, not a block: because of its extension, or because the file exists.
bool names_surface_file(const std::string& name);

}  // namespace tessera::api
