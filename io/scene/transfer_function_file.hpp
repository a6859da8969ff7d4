// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "colormaps/function_options.hpp"

namespace tessera::io {

/// Loads a preset (`NAME` or `NAME:VARIANT`, see colormaps/presets.hpp), a JSON text (is_json_text()) or a file. A file
/// that begins with `[` or `{` is JSON (json_transfer_function.hpp), any other is plain text. A preset takes precedence
/// over a file of the same name; `./viridis` is the file. Throws Error(bad_input) with a message of one line that names
/// file, line and remedy.
colormaps::LoadedTransferFunction load_transfer_function(const std::string& file_or_preset,
                                                         const colormaps::TransferFunctionOptions& options);

/// Parses plain text with one knot per line: `value r g b extinction`, separated by blanks. Values must not decrease.
/// Colours are linear, extinctions per world unit. `#` begins a comment; blank lines, CR LF and a UTF-8 byte order mark
/// are allowed. Commas are not allowed, because some locales write decimals with commas. Two lines with the same value
/// form a step.
colormaps::LoadedTransferFunction parse_text_transfer_function(std::string_view text, const std::string& source,
                                                               const colormaps::TransferFunctionOptions& options);

}  // namespace tessera::io
