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

/// Naps of the thread that calls MPI between two polls: a poll costs 20 to 30 us of a core that projects or composites.
/// They double in length while no message comes, and end when this process has something to do or another rank rings.
class Naps {
 public:
  /// Before a poll: a wake-up from now on ends the nap after it. Returns the bells in use, or null.
  std::shared_ptr<Bells> begin_look();
  /// After the poll. `came`: it found messages; `moving`: some are in transit and need further polls to proceed.
  void take(bool came, bool moving);

  // Called by any thread.
  void wake(int rank);
  /// While the rank's cores project, a poll in time for the next part of the frame is soon enough.
  void set_working(bool working, int rank);
  void use_bells(const std::shared_ptr<Bells>& bells, int rank);

 private:
  std::mutex mutex_;  // guards the members down to bells_
  std::condition_variable woken_;
  bool is_woken_ = false;
  std::shared_ptr<Bells> bells_;
  std::atomic<bool> working_ = false;

  // Used only by the thread that calls MPI.
  std::shared_ptr<Bells> looked_with_;
  std::uint32_t heard_ = 0;
  bool rang_ = false;
  std::chrono::microseconds length_{0};
};

}  // namespace tessera::exchange
