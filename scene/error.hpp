// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "tessera/error.hpp"

namespace tessera::scene {

/// The only exception type of the project. Libraries throw it at their boundary and never print or exit. `apps/`
/// converts an error to a line and an exit status, and replaces the names of settings by options.
using tessera::Error;
using tessera::ErrorCode;

using tessera::bad_input;

/// If the line of the error begins with `subject` and ": ", returns the error with all of `subject` as its subject. For
/// callers that passed the name of a file to a function that failed, since names may contain the separators at which
/// Error splits lines.
Error with_subject(const Error& error, std::string_view subject);

}  // namespace tessera::scene
