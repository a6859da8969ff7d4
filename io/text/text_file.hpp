// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scene/quote.hpp"

namespace tessera::io {

/// The whole of a small file (transfer function, camera). Throws Error(bad_input) if it is missing, a folder, or larger
/// than 64 MiB, which no such file is; Error(system_failure) if reading fails.
std::string read_text_file(const std::filesystem::path& file);

/// First character that is no blank, or 0 in an empty text; passes over a byte order mark.
char first_character(std::string_view text);

/// A finite double that fills the whole word, in the C locale whatever the user's is; a leading + is allowed.
std::optional<double> parse_number(std::string_view word);

using scene::quote;

}  // namespace tessera::io
