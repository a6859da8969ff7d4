// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/error.hpp"

namespace tessera::apps {

/// What the program reports to its caller. An error's code is one too.
enum class ExitCode : int {
  complete = 0,  ///< the picture is complete
  bad_input = static_cast<int>(ErrorCode::bad_input),
  system_failure = static_cast<int>(ErrorCode::system_failure),
  accuracy_not_met = 4,  ///< --verify found more error than was asked for
};

}  // namespace tessera::apps
