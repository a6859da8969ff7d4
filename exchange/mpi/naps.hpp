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

/// Naps of the thread that speaks MPI between two looks at it: a look costs 20 to 30 us of a core that projects or
/// composites. They double while nothing comes, and end when this process has something to do, or another rank rings.
class Naps {
 public:
  /// Before a look for messages: a wake-up from now on ends the nap after it. Returns the bells in use, or null.
  std::shared_ptr<Bells> begin_look();
  /// After the look. `came`: it found messages; `moving`: some are in transit and need further looks to proceed.
  void take(bool came, bool moving);

  // By any thread.
  void wake(int rank);
  /// While the rank's cores project, a look in time for the next part of the frame is soon enough.
  void set_working(bool working, int rank);
  void use_bells(const std::shared_ptr<Bells>& bells, int rank);

 private:
  std::mutex mutex_;  // guards what follows
  std::condition_variable woken_;
  bool is_woken_ = false;
  std::shared_ptr<Bells> bells_;
  std::atomic<bool> working_ = false;

  // The thread's alone.
  std::shared_ptr<Bells> looked_with_;
  std::uint32_t heard_ = 0;
  bool rang_ = false;
  std::chrono::microseconds length_{0};
};

}  // namespace tessera::exchange
