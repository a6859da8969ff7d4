// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/stall_watch.hpp"

#include <algorithm>

namespace tessera::exchange {

StallWatch::StallWatch(const std::vector<int>& ranks, Clock::duration timeout, Clock::time_point now)
    : timeout_(timeout), last_look_(now) {
  for (const int rank : ranks) ranks_[rank].next_notice = timeout;
}

void StallWatch::heard(int rank) {
  if (const auto at = ranks_.find(rank); at != ranks_.end()) at->second.was_heard = true;
}

void StallWatch::told(int rank) {
  if (const auto at = ranks_.find(rank); at != ranks_.end())
    at->second.next_notice = std::max(at->second.next_notice, 2 * at->second.silent + timeout_ / 4);
}

std::vector<StallWatch::Notice> StallWatch::look(Clock::time_point now) {
  const Clock::duration passed = std::min(now - last_look_, timeout_ / 8);
  last_look_ = now;
  std::vector<Notice> notices;
  for (auto& [rank, of] : ranks_) {
    of.silent += passed;
    if (of.was_heard) {
      if (of.was_noticed) notices.push_back({rank, of.silent, true});
      of = {{}, timeout_};
    } else if (of.silent >= of.next_notice) {
      notices.push_back({rank, of.silent, false});
      of.next_notice *= 2;
      of.was_noticed = true;
    }
  }
  return notices;
}

}  // namespace tessera::exchange
