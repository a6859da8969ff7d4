// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace tessera::readers {

/// Returns the names of the regular files that this process has opened for reading since the last call. Files opened by
/// its libraries are included, because the libraries call this program's own open() and fopen(). The caller records the
/// names (system/files_read.hpp).
std::vector<std::string> take_opened_files();

}  // namespace tessera::readers
