// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <map>
#include <vector>

namespace tessera::exchange {

/// Which ranks have been silent for too long. Bookkeeping only: the caller says what time it is and whom it heard.
///
/// Time in which the watcher itself did not run (a suspended machine, a job that was stopped as a whole) counts for
/// nobody: between two looks at most an eighth of the timeout passes.
class StallWatch {
 public:
  using Clock = std::chrono::steady_clock;

  struct Notice {
    int rank;
    Clock::duration silent;  ///< for how long it has been, or was
    bool back;               ///< it has been heard again; else it has not
  };

  /// Watches `ranks` from `now` on. A rank is noticed when it has been silent for `timeout`, and again after twice that
  /// time, four times, and so on.
  StallWatch(const std::vector<int>& ranks, Clock::duration timeout, Clock::time_point now);

  /// A message of that rank came. Ranks that are not watched are ignored.
  void heard(int rank);
  /// Somebody else has told of this rank's silence, and will of its return. The next notice is a little after theirs.
  void told(int rank);
  /// What there is to say since the last look.
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
