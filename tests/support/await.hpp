// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <thread>

namespace tessera::test {

/// How long a test waits for an expected event: only a hang takes this long.
inline constexpr std::chrono::minutes hang{5};

/// Waits until `event` is true, checking after each `pause`. False: it did not occur, the program hangs.
template <class Event>
bool await(const Event& event, std::chrono::milliseconds pause = std::chrono::milliseconds(2)) {
  const auto end = std::chrono::steady_clock::now() + hang;
  while (!event()) {
    if (std::chrono::steady_clock::now() > end) return false;
    if (pause.count() > 0) std::this_thread::sleep_for(pause);
  }
  return true;
}

}  // namespace tessera::test
