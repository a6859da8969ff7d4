// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tessera::readers {

/// Refuses binary legacy VTK files whose numbers are little-endian, although the format is big-endian: throws
/// Error(bad_input). VTK's reader would use wrong sizes that make it crash, and show noise.
void require_big_endian(const std::filesystem::path& file);

}  // namespace tessera::readers
