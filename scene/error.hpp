#pragma once

#include <string>
#include <string_view>

#include "tessera/error.hpp"

namespace tessera::scene {

/// The one exception of the project. Libraries throw it at their boundary and never print or exit; `apps/` turns it
/// into a line and a status, and the names of settings in it into options.
using tessera::Error;
using tessera::ErrorCode;

/// What the process reports to its caller (the program's exit status). An error's code is one too.
enum class ExitCode : int {
  complete = 0,  ///< the picture is complete
  bad_input = static_cast<int>(ErrorCode::bad_input),
  system_failure = static_cast<int>(ErrorCode::system_failure),
  accuracy_not_met = 4,  ///< --verify found more error than was asked for
};

/// Shorthand for the most frequent case.
inline Error bad_input(const std::string& message) { return {ErrorCode::bad_input, message}; }

/// The same error, with all of `subject` as its subject if the line begins with `SUBJECT: `. For who has given a file's
/// name to something that may fail: names may hold what Error splits lines at.
Error with_subject(const Error& error, std::string_view subject);

}  // namespace tessera::scene
