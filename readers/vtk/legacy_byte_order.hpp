// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tessera::readers {

/// Refuses binary legacy VTK files whose numbers are little-endian, although the format has them big-endian: throws
/// Error(bad_input). VTK's reader takes sizes from them that make it crash, and draws the rest as noise.
void require_big_endian(const std::filesystem::path& file);

}  // namespace tessera::readers
