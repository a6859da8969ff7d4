#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tessera/verification.hpp"

namespace tessera::apps {

/// `verify frame 3: 1000 pixels, max 1.2e-06 rms 2.1e-08, worst at (512, 33), 0 excused; bound 2e-05 met; worst: edge;
/// chosen: 334 random, 223 edge, 222 tie, 221 step`
std::string verification_line(const Verification& verification, int frame_number);

/// The report's "verify".
nlohmann::ordered_json verification_json(const Verification& verification);

}  // namespace tessera::apps
