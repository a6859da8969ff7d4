// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/scene/chrome_trace.hpp"

namespace tessera::io {

using tessera::FileSpan;
using tessera::TraceFile;

/// Reads the output of write_chrome_trace, also if it was edited: skips events and fields of other programs and accepts
/// a bare array of events. Parses the file as a stream, without a tree: takes 64 bytes per span, half the size of its
/// text.
///
/// Throws Error(bad_input) if the text is truncated or not JSON, if an event of ours has no valid time, or if it has no
/// span of ours.
TraceFile parse_chrome_trace(std::string_view text, const std::string& source);
TraceFile read_chrome_trace(const std::filesystem::path& file);

}  // namespace tessera::io
