// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "exchange/heartbeats.hpp"
#include "exchange/message.hpp"

namespace tessera::exchange {

/// Heartbeats, from the call of watch() on. Before it, none are sent, and those of other ranks are kept.
class Liveness {
 public:
  /// Called by any thread, before or during the other calls.
  void watch(const StallSettings& settings);

  /// To be called repeatedly, with this rank: returns the messages to send now. Throws Error(system_failure) if a
  /// message that came before watch() is not one of Heartbeats.
  std::vector<Heartbeats::Outgoing> turn(int rank, int size);
  /// A message of another kind has come from that rank.
  void heard(int from);
  /// A message of turn() has come. Throws like Heartbeats::take().
  void take(Message message);

  /// The run's error once a rank's silence ends the run; null before.
  [[nodiscard]] const scene::Error* lost() const;

 private:
  std::mutex mutex_;
  std::optional<StallSettings> wanted_;  ///< guarded; set until the watch begins
  std::optional<Heartbeats> heartbeats_;
  std::vector<Message> early_;  ///< from ranks that already watch
};

}  // namespace tessera::exchange
