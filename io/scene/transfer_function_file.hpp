// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "colormaps/function_options.hpp"

namespace tessera::io {

/// Loads a preset (`NAME` or `NAME:VARIANT`, see colormaps/presets.hpp), a JSON text (is_json_text()) or a file: JSON
/// (json_transfer_function.hpp) if it begins with `[` or `{`, plain text otherwise. A preset takes precedence over a
/// file of the same name; `./viridis` is the file. Throws Error(bad_input) in one line naming file, line and remedy.
colormaps::LoadedTransferFunction load_transfer_function(const std::string& file_or_preset,
                                                         const colormaps::TransferFunctionOptions& options);

/// Plain text, one knot per line: `value r g b extinction`, separated by blanks, values not decreasing. Colours are
/// linear, extinctions per world unit. `#` begins a comment; blank lines, CR LF and a UTF-8 byte order mark are
/// allowed. Commas are not, because some locales write decimals with them. Two lines with the same value form a step.
colormaps::LoadedTransferFunction parse_text_transfer_function(std::string_view text, const std::string& source,
                                                               const colormaps::TransferFunctionOptions& options);

}  // namespace tessera::io
