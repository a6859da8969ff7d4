// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tessera::readers {

/// Throws Error(bad_input) for GAMBIT files with second-order elements, whose nodes VTK's reader would interpret as
/// further elements. Other files are left to the reader.
void require_linear_gambit(const std::filesystem::path& file);

/// For an EnSight 6 case whose geometry has second-order elements, returns a note that VTK's reader reads only their
/// corners. Empty for all other cases, including EnSight Gold.
std::string note_on_ensight6(const std::filesystem::path& case_file);

}  // namespace tessera::readers
