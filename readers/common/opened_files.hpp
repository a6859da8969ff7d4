// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tessera::readers {

/// Returns the names of the regular files that this process has opened for reading since the last call. Files opened by
/// its libraries are included, because the libraries call this program's own open() and fopen(). The caller records the
/// names (system/files_read.hpp).
std::vector<std::string> take_opened_files();

/// Records a file to which the input refers and which may not be opened, such as a file of another time step. The
/// caller only protects it from being replaced by outputs.
void note_named_file(const std::filesystem::path& file);

/// Returns the names that were passed to note_named_file() since the last call.
std::vector<std::string> take_named_files();

}  // namespace tessera::readers
