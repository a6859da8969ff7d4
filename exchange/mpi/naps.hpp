// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>

#include "exchange/bells.hpp"

namespace tessera::exchange {

/// Pauses between two polls of the thread that calls MPI. A poll costs 20 to 30 us of a core that projects or
/// composites. The pauses double in length while no message comes. A pause ends early when this process has something
/// to do or another rank rings.
class Naps {
 public:
  /// Must be called before a poll: a wake-up after this call ends the nap that follows the poll. Returns the bells in
  /// use, or null.
  std::shared_ptr<Bells> begin_look();
  /// Naps; called after the poll. `came`: the poll found messages; `moving`: some messages are in transit and need
  /// further polls to proceed.
  void take(bool came, bool moving);

  // These functions may be called by any thread.
  void wake(int rank);
  /// Sets whether the rank's cores project. While they do, polling is only needed in time for the next part of the
  /// frame.
  void set_working(bool working, int rank);
  void use_bells(const std::shared_ptr<Bells>& bells, int rank);

 private:
  std::mutex mutex_;  // guards is_woken_ and bells_
  std::condition_variable woken_;
  bool is_woken_ = false;
  std::shared_ptr<Bells> bells_;
  std::atomic<bool> working_ = false;

  // These members are used only by the thread that calls MPI.
  std::shared_ptr<Bells> looked_with_;
  std::uint32_t heard_ = 0;
  bool rang_ = false;
  std::chrono::microseconds length_{0};
};

}  // namespace tessera::exchange
