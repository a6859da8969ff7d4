// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "exchange/heartbeats.hpp"
#include "exchange/message.hpp"

namespace tessera::exchange {

/// Sends and checks heartbeats from the call of watch() on. Before this call, it sends no heartbeats and stores those
/// of other ranks.
class Liveness {
 public:
  /// Starts the watch. May be called by any thread, before or during the other calls.
  void watch(const StallSettings& settings);

  /// Must be called repeatedly, with this rank and the number of ranks. Returns the messages to send now. Throws
  /// Error(system_failure) if a message that came before watch() is not a message of Heartbeats.
  std::vector<Heartbeats::Outgoing> turn(int rank, int size);
  /// Records that a message other than a heartbeat has come from rank `from`.
  void heard(int from);
  /// Takes a message that another rank's turn() returned. Throws like Heartbeats::take().
  void take(Message message);

  /// The run's error after a rank's silence has ended the run; null before.
  [[nodiscard]] const scene::Error* lost() const;

 private:
  std::mutex mutex_;
  std::optional<StallSettings> wanted_;  ///< guarded by `mutex_`; set until the watch begins
  std::optional<Heartbeats> heartbeats_;
  std::vector<Message> early_;  ///< messages from ranks that already watch
};

}  // namespace tessera::exchange
