// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <map>
#include <vector>

namespace tessera::exchange {

/// Detects ranks that have been silent for too long. This class only keeps records: the caller passes the current time
/// and the ranks from which messages came.
///
/// Time in which the watcher itself did not run (because the machine was suspended, or the whole job was stopped) does
/// not count: at most an eighth of the timeout is counted between two calls of look().
class StallWatch {
 public:
  using Clock = std::chrono::steady_clock;

  struct Notice {
    int rank;
    Clock::duration silent;  ///< duration of the silence so far, or of the silence that has ended
    bool back;               ///< true: messages come from the rank again; false: it is still silent
  };

  /// Watches `ranks` from `now` on. look() returns a notice for a rank when the rank has been silent for `timeout`, and
  /// again after twice that time, four times, and so on.
  StallWatch(const std::vector<int>& ranks, Clock::duration timeout, Clock::time_point now);

  /// Records that a message has come from rank `rank`. Ranks that are not watched are ignored.
  void heard(int rank);
  /// Records that another rank has reported the silence of rank `rank`, and will report its return. The next notice
  /// here comes a little after the next notice of that other rank.
  void told(int rank);
  /// Returns the notices that have become due since the last call.
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
