// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tessera::readers {

/// Refuses GAMBIT files with elements of second order, whose nodes VTK's reader would take for the next elements:
/// throws Error(bad_input). What is no such file is left to the reader.
void require_linear_gambit(const std::filesystem::path& file);

/// Of an EnSight 6 case whose geometry has elements of second order a note that VTK's reader knows their corners alone;
/// empty for all others, EnSight Gold among them.
std::string note_on_ensight6(const std::filesystem::path& case_file);

}  // namespace tessera::readers
