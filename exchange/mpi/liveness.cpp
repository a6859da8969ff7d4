// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/mpi/liveness.hpp"

#include <utility>

#include "exchange/run_faults.hpp"

namespace tessera::exchange {

void Liveness::watch(const StallSettings& settings) {
  const std::lock_guard lock(mutex_);
  wanted_ = settings;
}

std::vector<Heartbeats::Outgoing> Liveness::turn(int rank, int size) {
  const auto now = Heartbeats::Clock::now();
  {
    const std::lock_guard lock(mutex_);
    if (wanted_ && size > 1) heartbeats_.emplace(rank, size, *wanted_, process_name(), now);
    wanted_.reset();
  }
  if (!heartbeats_) return {};
  for (const Message& beat : std::exchange(early_, {})) heartbeats_->take(beat.from, beat.bytes);
  return heartbeats_->turn(now);
}

void Liveness::heard(int from) {
  if (heartbeats_) heartbeats_->heard(from);
}

void Liveness::take(Message message) {
  if (heartbeats_)
    heartbeats_->take(message.from, message.bytes);
  else
    early_.push_back(std::move(message));
}

const scene::Error* Liveness::lost() const {
  return heartbeats_ && heartbeats_->lost() ? &heartbeats_->lost()->error : nullptr;
}

}  // namespace tessera::exchange
