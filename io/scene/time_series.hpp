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

/// Throws Error(bad_input) unless the input is there: a file, or of a time series at least one step. For what must not
/// be said of a file that is not there, such as that it is a mesh.
void require_input(const std::filesystem::path& input);

/// The text of a ParaView file series, {"file-series-version", "files": [{"name", "time"}, ...]}, in the order of time;
/// names are against the folder of `input`. Entries without a time have their place in the list. Each is a step of its
/// own, whatever others have its time. Throws Error(bad_input).
std::vector<TimeStep> parse_file_series(std::string_view text, const std::filesystem::path& input);

}  // namespace tessera::io
