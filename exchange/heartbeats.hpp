// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "exchange/stall_watch.hpp"
#include "exchange/transport.hpp"
#include "tessera/job.hpp"

namespace tessera::exchange {

using tessera::StallSettings;

/// One rank's part in finding ranks that have stopped: what it tells the others, and what it makes of their silence.
///
/// Eight times in a timeout every rank sends a heartbeat to rank 0, and rank 0 one to each; any other message is as
/// good. They come from the thread that speaks MPI, so that a rank which computes for hours is heard, and one whose
/// process or machine stands still is not. Rank 0 watches all others. These watch rank 0, and the lowest of them that
/// runs speaks of it: rank r waits r quarters of a second longer and is silent if another has told it.
///
/// Bookkeeping only: the caller moves the messages, and says what time it is.
class Heartbeats {
 public:
  using Clock = StallWatch::Clock;

  /// `name` of this rank's process, for people: machine and number.
  Heartbeats(int rank, int size, StallSettings settings, std::string name, Clock::time_point now);

  struct Outgoing {
    int to;
    Bytes bytes;
  };
  /// To be called again and again: what to send now. Says what there is to say.
  std::vector<Outgoing> turn(Clock::time_point now);

  /// A message of another kind came from that rank.
  void heard(int from) { watch_.heard(from); }
  /// A message of turn() came. Throws Error(system_failure) if it is not one.
  void take(int from, const Bytes& bytes);

  /// The rank whose silence ends the run, and the run's error: with StallSettings::ends_run.
  struct Lost {
    int rank;
    scene::Error error;
  };
  [[nodiscard]] const std::optional<Lost>& lost() const { return lost_; }

 private:
  [[nodiscard]] std::string name_of(int rank) const;
  void notice(const StallWatch::Notice& notice, std::vector<Outgoing>& messages);

  int rank_, size_;
  StallSettings settings_;
  StallWatch watch_;
  std::vector<std::string> names_;  ///< of processes, by rank; empty until heard
  Clock::duration interval_;
  Clock::time_point next_beat_;
  std::optional<Lost> lost_;
};

}  // namespace tessera::exchange
