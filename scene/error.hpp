// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "tessera/error.hpp"

namespace tessera::scene {

/// The one exception of the project. Libraries throw it at their boundary and never print or exit; `apps/` turns it
/// into a line and a status, and the names of settings in it into options.
using tessera::Error;
using tessera::ErrorCode;

using tessera::bad_input;

/// The same error, with all of `subject` as its subject if the line begins with `SUBJECT: `. For who has given a file's
/// name to something that may fail: names may hold what Error splits lines at.
Error with_subject(const Error& error, std::string_view subject);

}  // namespace tessera::scene
