// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

namespace tessera::apps {

/// Implements `tessera timing`: prints how traced runs spent their time (analysis/timing_breakdown.hpp) and, if paths
/// are given, writes it as CSV and as a figure (.svg, .png). Throws Error.
void timing(const std::vector<std::filesystem::path>& traces, const std::filesystem::path& csv,
            const std::filesystem::path& figure);

}  // namespace tessera::apps
