// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "exchange/shared_pages.hpp"

namespace tessera::exchange {

/// Bells of ranks of one machine, in memory that they share: who sends to a rank rings, so that the rank need not look
/// for messages all the time. A look at MPI costs 20 to 30 microseconds.
class Bells {
 public:
  /// Those of this rank's machine; null if it has no other ranks or no shared memory. Collective over all ranks.
  static std::shared_ptr<Bells> hung(Transport& transport);

  /// Whether every rank of the transport is on this machine.
  [[nodiscard]] bool of_all() const { return of_all_; }
  /// Wakes a rank; nothing if it is not on this machine.
  void ring(int rank);
  /// Of this rank, before it looks for what the bell may have rung for.
  [[nodiscard]] std::uint32_t heard() const;
  /// Returns when this rank's bell has rung since heard(), or after `most`.
  void wait(std::uint32_t heard, std::chrono::microseconds most);

 private:
  Bells(Transport& transport, PagesOfMachine shared);
  [[nodiscard]] std::atomic<std::uint32_t>& bell(int place) const;

  SharedPages pages_;
  std::vector<int> places_;  ///< of each rank among those of this machine; -1: it is elsewhere
  int own_;
  bool of_all_;
};

}  // namespace tessera::exchange
