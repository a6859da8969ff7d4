// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tessera::readers {

/// Returns the first unexpected word of a legacy VTK file in text form, as "line 12: 'foo' is where a number is
/// expected"; empty if none is found, and for binary files. Called for files on which VTK's reader has failed, because
/// that reader does not report a line and skips some unexpected words.
std::string odd_legacy_word(const std::filesystem::path& file);

}  // namespace tessera::readers
