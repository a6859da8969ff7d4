// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "tessera/trace.hpp"

namespace tessera::server {

/// Divides the milliseconds of a frame among its stages, by the time that threads spent in each, excluding nested
/// stages. If there are any results, their sum is `frame_ms`.
std::map<std::string, double> stage_times(std::vector<TraceSpan> spans, double frame_ms);

}  // namespace tessera::server
