#pragma once

#include <stdexcept>
#include <string>

namespace tessera::scene {

/// What the process reports to its caller (the program's exit status).
enum class ExitCode : int {
  complete = 0,          ///< the picture is complete
  bad_input = 2,         ///< a file or an argument is wrong; the user can mend it
  system_failure = 3,    ///< disk, memory, GPU, a lost rank
  accuracy_not_met = 4,  ///< --verify found more error than was asked for
};

/// The one exception of the project. The message is one line: `FILE: what is wrong and where; what to do`.
/// Libraries throw it at their boundary and never print or exit; `apps/` turns it into a line and a status.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// Shorthand for the most frequent case.
inline Error bad_input(const std::string& message) { return Error(ExitCode::bad_input, message); }

}  // namespace tessera::scene
