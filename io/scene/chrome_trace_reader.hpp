// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/scene/chrome_trace.hpp"

namespace tessera::io {

using tessera::FileSpan;
using tessera::TraceFile;

/// Parses the output of write_chrome_trace, even if it was edited: skips events and fields of other programs and
/// accepts a bare array of events. Parses the file as a stream, without a tree: needs 64 bytes per span, half the size
/// of the span's text.
///
/// Throws Error(bad_input) if the text is truncated or not JSON, if an event of Tessera has an invalid time, or if the
/// text contains no span of Tessera.
TraceFile parse_chrome_trace(std::string_view text, const std::string& source);
TraceFile read_chrome_trace(const std::filesystem::path& file);

}  // namespace tessera::io
