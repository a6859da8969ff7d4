// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/mpi/naps.hpp"

#include <algorithm>

namespace tessera::exchange {
namespace {

using std::chrono::microseconds;

struct Lengths {
  microseconds shortest, longest_moving, longest;
};
constexpr Lengths idle{microseconds(100), microseconds(500), microseconds(2000)};
constexpr Lengths working{microseconds(2000), microseconds(2000), microseconds(5000)};

// Longest nap when other ranks ring the bell after sending.
constexpr microseconds longest_with_bells(20'000);

}  // namespace

std::shared_ptr<Bells> Naps::begin_look() {
  {
    const std::lock_guard lock(mutex_);
    is_woken_ = false;
    looked_with_ = bells_;
  }
  heard_ = looked_with_ != nullptr ? looked_with_->heard() : 0;
  return looked_with_;
}

void Naps::take(bool came, bool moving) {
  // A rank whose cores project does not listen to the bells, because it would poll too often.
  Bells* const listens_to = working_ ? nullptr : looked_with_.get();
  Lengths lengths = working_ ? working : idle;
  if (listens_to != nullptr && listens_to->of_all() && !moving) lengths.longest = longest_with_bells;
  // The bell may ring a little before MPI shows the message.
  const bool soon = came || rang_;
  length_ = soon ? lengths.shortest
                 : std::clamp(2 * length_, lengths.shortest, moving ? lengths.longest_moving : lengths.longest);
  rang_ = false;
  {
    std::unique_lock lock(mutex_);
    if (listens_to == nullptr) woken_.wait_for(lock, length_, [&] { return is_woken_; });
    if (listens_to == nullptr || is_woken_) return;
  }
  listens_to->wait(heard_, length_);
  rang_ = listens_to->heard() != heard_;
}

void Naps::wake(int rank) {
  std::shared_ptr<Bells> bells;
  {
    const std::lock_guard lock(mutex_);
    is_woken_ = true;
    bells = bells_;
  }
  woken_.notify_all();
  if (bells != nullptr) bells->ring(rank);
}

void Naps::set_working(bool working, int rank) {
  working_ = working;
  if (!working) wake(rank);
}

void Naps::use_bells(const std::shared_ptr<Bells>& bells, int rank) {
  {
    const std::lock_guard lock(mutex_);
    bells_ = bells;
  }
  wake(rank);
}

}  // namespace tessera::exchange
