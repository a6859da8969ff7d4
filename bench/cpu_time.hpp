// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ctime>

namespace tessera::bench {

/// Seconds of processor time, which other work on the machine affects less than wall time.
inline double seconds_of(clockid_t clock) {
  timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}
inline double thread_seconds() { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }
inline double process_seconds() { return seconds_of(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace tessera::bench
