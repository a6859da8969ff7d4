// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tessera::readers {

/// The first word of a legacy VTK file in text that the format does not have there, as "line 12: 'foo' is where a
/// number is expected"; empty if none is seen, and of binary files. For files that VTK's reader has failed on: it names
/// no line, and passes over some such words.
std::string odd_legacy_word(const std::filesystem::path& file);

}  // namespace tessera::readers
