// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/error.hpp"

namespace tessera::apps {

/// The exit statuses of the program, which include the codes of errors.
enum class ExitCode : int {
  complete = 0,  ///< the image is complete
  bad_input = static_cast<int>(ErrorCode::bad_input),
  system_failure = static_cast<int>(ErrorCode::system_failure),
  accuracy_not_met = 4,  ///< --verify found a larger error than requested
};

}  // namespace tessera::apps
