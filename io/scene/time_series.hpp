// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "tessera/time_series.hpp"

namespace tessera::io {

using tessera::is_time_series;
using tessera::read_time_series;
using tessera::TimeStep;

/// Throws Error(bad_input) unless the input exists: a file, or at least one step of a time series. Must be called
/// first, because other checks would report misleading errors for a missing file, for example that it is a mesh.
void require_input(const std::filesystem::path& input);

/// Parses a ParaView file series, {"file-series-version", "files": [{"name", "time"}, ...]}, and sorts the entries by
/// time. Names are relative to the directory of `input`. The time of an entry that does not state it is the entry's
/// index. Entries with equal times remain separate steps. Throws Error(bad_input).
std::vector<TimeStep> parse_file_series(std::string_view text, const std::filesystem::path& input);

}  // namespace tessera::io
