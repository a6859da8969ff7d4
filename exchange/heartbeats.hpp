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

/// One rank's part in finding ranks that have stopped: its messages to the others, and how it reacts to their silence.
///
/// Eight times per timeout, every rank sends a heartbeat to rank 0, and rank 0 one to each; any other message counts as
/// one. They come from the thread that calls MPI, so that a rank that computes for hours is not considered silent, but
/// one whose process or machine has stopped is. Rank 0 watches all others. They watch rank 0, and the lowest running
/// one of them reports its silence: rank r waits r quarters of a second longer and reports nothing if another has.
///
/// Bookkeeping only: the caller transfers the messages and passes the time.
class Heartbeats {
 public:
  using Clock = StallWatch::Clock;

  /// `name` identifies this rank's process to users: machine and process number.
  Heartbeats(int rank, int size, StallSettings settings, std::string name, Clock::time_point now);

  struct Outgoing {
    int to;
    Bytes bytes;
  };
  /// To be called repeatedly: returns the messages to send now, and reports silent ranks and their return.
  std::vector<Outgoing> turn(Clock::time_point now);

  /// A message of another kind has come from that rank.
  void heard(int from) { watch_.heard(from); }
  /// A message of turn() has come. Throws Error(system_failure) if it is not one.
  void take(int from, const Bytes& bytes);

  /// The rank whose silence ends the run, and the run's error. Only with StallSettings::ends_run.
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
  std::vector<std::string> names_;  ///< of processes, by rank; empty until received
  Clock::duration interval_;
  Clock::time_point next_beat_;
  std::optional<Lost> lost_;
};

}  // namespace tessera::exchange
