// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>

namespace tessera::system {

/// Notices that a process waits for something that does not come: it uses no processor time, and all its threads sleep.
/// One that waits for a disk, that has been stopped, or that no processor is free for, is in another state.
class IdleWatch {
 public:
  explicit IdleWatch(pid_t process) : process_(process) {}

  /// For how long every look has found it idle, and the same time used. To be called often.
  std::chrono::steady_clock::duration look();

 private:
  pid_t process_;
  std::int64_t used_ = -1;  ///< nanoseconds of processor time
  std::chrono::steady_clock::time_point since_{};
};

}  // namespace tessera::system
