// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scene/quote.hpp"

namespace tessera::io {

/// The whole of a small file (transfer function, camera). Throws Error(bad_input) if it is missing, a directory, or
/// larger than 64 MiB, which no such file needs; Error(system_failure) if reading fails.
std::string read_text_file(const std::filesystem::path& file);

/// The first non-blank character, or 0 in an empty text; skips a byte order mark.
char first_character(std::string_view text);

/// A finite double that fills the whole word, in the C locale regardless of the user's; a leading + is allowed.
std::optional<double> parse_number(std::string_view word);

using scene::quote;

}  // namespace tessera::io
