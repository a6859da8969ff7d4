// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "tessera/program/text.hpp"

namespace tessera::io {

/// Reads the whole of a small file (transfer function, camera), or of a pipe. Throws Error(bad_input) if the file is
/// missing, a directory, a device other than standard input, or larger than 64 MiB, which exceeds any useful file of
/// this kind; Error(system_failure) if reading fails.
std::string read_text_file(const std::filesystem::path& file);

/// Returns the first non-blank character, or 0 for an empty text; skips a byte order mark.
char first_character(std::string_view text);

/// Parses a finite double that fills the whole word, in the C locale regardless of the user's locale. A leading + is
/// allowed.
std::optional<double> parse_number(std::string_view word);

}  // namespace tessera::io
