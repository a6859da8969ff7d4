// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

namespace tessera::apps {

/// `tessera timing`: where the time of traced runs went (analysis/timing_breakdown.hpp), as text on stdout, and as CSV
/// and figure (.svg, .png) where paths are given. Throws Error.
void timing(const std::vector<std::filesystem::path>& traces, const std::filesystem::path& csv,
            const std::filesystem::path& figure);

}  // namespace tessera::apps
