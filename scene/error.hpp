// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "tessera/error.hpp"

namespace tessera::scene {

/// The only exception type of the project. Libraries throw it at their boundary and never print or exit; `apps/` turns
/// it into a line and a status, and the names of settings in it into options.
using tessera::Error;
using tessera::ErrorCode;

using tessera::bad_input;

/// The same error, with all of `subject` as its subject if the line begins with `SUBJECT: `. For callers that passed a
/// file's name to a function that failed: names may contain the separators at which Error splits lines.
Error with_subject(const Error& error, std::string_view subject);

}  // namespace tessera::scene
