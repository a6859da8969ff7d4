// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tessera::readers {

/// Throws Error(bad_input) for binary legacy VTK files whose numbers are little-endian, although the format is
/// big-endian. For these files, VTK's reader would use wrong sizes that make it crash, or read noise.
void require_big_endian(const std::filesystem::path& file);

}  // namespace tessera::readers
