// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tessera::readers {

/// Refuses GAMBIT files with second-order elements, whose nodes VTK's reader would interpret as the next elements:
/// throws Error(bad_input). Other files are left to the reader.
void require_linear_gambit(const std::filesystem::path& file);

/// For an EnSight 6 case whose geometry has second-order elements, a note that VTK's reader reads only their corners;
/// empty for all others, including EnSight Gold.
std::string note_on_ensight6(const std::filesystem::path& case_file);

}  // namespace tessera::readers
