// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace tessera::readers {

/// Names of the regular files that this process has opened for reading since the last call, including those opened by
/// its libraries: they call this program's own open() and fopen(). The caller records them (system/files_read.hpp).
std::vector<std::string> take_opened_files();

}  // namespace tessera::readers
