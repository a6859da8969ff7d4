// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

namespace tessera::apps {

/// `tessera timing`: prints where traced runs spent their time (analysis/timing_breakdown.hpp) as text, and writes it
/// as CSV and as a figure (.svg, .png) if paths are given. Throws Error.
void timing(const std::vector<std::filesystem::path>& traces, const std::filesystem::path& csv,
            const std::filesystem::path& figure);

}  // namespace tessera::apps
