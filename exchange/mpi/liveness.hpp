// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "exchange/heartbeats.hpp"
#include "exchange/message.hpp"

namespace tessera::exchange {

/// Heartbeats from when stalls are to be watched for; before that nothing is sent, and what others send is kept.
class Liveness {
 public:
  /// By any thread, before or while the others are called.
  void watch(const StallSettings& settings);

  /// To be called again and again, with this rank: the messages to send now. Throws Error(system_failure) if one that
  /// came before this rank watched is not one of Heartbeats.
  std::vector<Heartbeats::Outgoing> turn(int rank, int size);
  /// A message of another kind came from that rank.
  void heard(int from);
  /// A message of turn() came. Throws as Heartbeats::take().
  void take(Message message);

  /// The run's error once a rank's silence ends it; null before.
  [[nodiscard]] const scene::Error* lost() const;

 private:
  std::mutex mutex_;
  std::optional<StallSettings> wanted_;  ///< guarded; until the watch begins
  std::optional<Heartbeats> heartbeats_;
  std::vector<Message> early_;  ///< of ranks that watch already
};

}  // namespace tessera::exchange
