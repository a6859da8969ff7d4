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

/// One rank's part in detecting ranks that have stopped: the heartbeats that it sends, and its reaction to the silence
/// of others.
///
/// Eight times per timeout, every rank sends a heartbeat to rank 0, and rank 0 sends a heartbeat to each rank. Any
/// other message counts as a heartbeat. Heartbeats come from the thread that calls MPI. So a rank that computes for
/// hours is not considered silent, but a rank whose process or machine has stopped is. Rank 0 watches all other ranks.
/// The other ranks watch rank 0, and the lowest of them that still runs reports the silence of rank 0: rank r
/// waits 0.25 r seconds longer, and reports nothing if another rank has reported the silence.
///
/// This class only keeps records: the caller transfers the messages and passes the current time.
class Heartbeats {
 public:
  using Clock = StallWatch::Clock;

  /// `name` identifies this rank's process to users: machine and process number.
  Heartbeats(int rank, int size, StallSettings settings, std::string name, Clock::time_point now);

  struct Outgoing {
    int to;
    Bytes bytes;
  };
  /// Must be called repeatedly. Returns the messages to send now, and reports ranks that have become silent or have
  /// returned.
  std::vector<Outgoing> turn(Clock::time_point now);

  /// Records that a message other than a heartbeat has come from rank `from`.
  void heard(int from) { watch_.heard(from); }
  /// Takes a message that another rank's turn() returned. Throws Error(system_failure) if `bytes` are not such a
  /// message.
  void take(int from, const Bytes& bytes);

  /// The rank whose silence ends the run, and the error with which the run ends. Only with StallSettings::ends_run.
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
  std::vector<std::string> names_;  ///< process name of each rank; empty until received
  Clock::duration interval_;
  Clock::time_point next_beat_;
  std::optional<Lost> lost_;
};

}  // namespace tessera::exchange
