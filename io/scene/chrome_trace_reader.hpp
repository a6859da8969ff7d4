// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/scene/chrome_trace.hpp"

namespace tessera::io {

using tessera::FileSpan;
using tessera::TraceFile;

/// Reads what write_chrome_trace wrote, also when edited: other programs' events and fields are passed over, a bare
/// array of events will do. Takes the file as it streams by: 64 bytes a span, half of its text, and no tree.
///
/// Throws Error(bad_input): not JSON, or cut off; an event of ours without time or with a time that is none; not one
/// span of ours in it.
TraceFile parse_chrome_trace(std::string_view text, const std::string& source);
TraceFile read_chrome_trace(const std::filesystem::path& file);

}  // namespace tessera::io
