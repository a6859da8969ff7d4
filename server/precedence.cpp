// SPDX-License-Identifier: BSD-3-Clause
#include "server/precedence.hpp"

#include <algorithm>

namespace tessera::server {

void Precedence::begin_short(Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  credit_ = std::min(most_credit, credit_ + earned * (now - since_));
  held_ = credit_ > Clock::duration::zero();
  since_ = now;
}

void Precedence::end_short(Clock::time_point now) {
  {
    const std::lock_guard lock(mutex_);
    if (!held_) return;  // this interval is counted as long work
    credit_ -= now - since_;
    since_ = now;
    held_ = false;
  }
  changed_.notify_all();
}

void Precedence::pass(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, stop, [this] { return !held_; });
}

bool Precedence::is_held() const {
  const std::lock_guard lock(mutex_);
  return held_;
}

}  // namespace tessera::server
