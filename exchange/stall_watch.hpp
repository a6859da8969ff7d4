// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <map>
#include <vector>

namespace tessera::exchange {

/// Finds ranks that have been silent for too long. Bookkeeping only: the caller passes the time and the ranks from
/// which messages came.
///
/// Time in which the watcher itself did not run (a suspended machine, a job that was stopped as a whole) does not
/// count: at most an eighth of the timeout is counted between two calls of look().
class StallWatch {
 public:
  using Clock = std::chrono::steady_clock;

  struct Notice {
    int rank;
    Clock::duration silent;  ///< for how long it has been, or was
    bool back;               ///< messages come from it again; otherwise it is still silent
  };

  /// Watches `ranks` from `now` on. A notice for a rank comes when it has been silent for `timeout`, and again after
  /// twice that time, four times, and so on.
  StallWatch(const std::vector<int>& ranks, Clock::duration timeout, Clock::time_point now);

  /// A message from that rank has come. Ranks that are not watched are ignored.
  void heard(int rank);
  /// Another rank has reported this rank's silence, and will report its return. The next notice here comes a little
  /// after theirs.
  void told(int rank);
  /// The notices since the last call.
  std::vector<Notice> look(Clock::time_point now);

 private:
  struct Silence {
    Clock::duration silent{}, next_notice;
    bool was_heard = false, was_noticed = false;
  };
  Clock::duration timeout_;
  Clock::time_point last_look_;
  std::map<int, Silence> ranks_;
};

}  // namespace tessera::exchange
