// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>

namespace tessera::system {

/// Detects that a process waits for something that does not arrive: the process uses no processor time, and all its
/// threads sleep. A process that waits for a disk or a processor, or is stopped, is in another state.
class IdleWatch {
 public:
  explicit IdleWatch(pid_t process) : process_(process) {}

  /// Returns the time for which all calls have found the process idle with the same processor time. Must be called
  /// often.
  std::chrono::steady_clock::duration look();

 private:
  pid_t process_;
  std::int64_t used_ = -1;  ///< processor time in nanoseconds
  std::chrono::steady_clock::time_point since_{};
};

}  // namespace tessera::system
