// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "exchange/shared_pages.hpp"

namespace tessera::exchange {

/// Wake-ups between ranks of one machine, in shared memory. A rank that sends a message rings the bell of the receiver,
/// so that the receiver need not poll MPI all the time. One poll of MPI costs 20 to 30 microseconds.
class Bells {
 public:
  /// Returns the bells of this rank's machine; null if the machine has no other ranks or no shared memory. Collective
  /// over all ranks.
  static std::shared_ptr<Bells> hung(Transport& transport);

  /// Whether every rank of the transport is on this machine.
  [[nodiscard]] bool of_all() const { return of_all_; }
  /// Wakes a rank; no effect if it is on another machine.
  void ring(int rank);
  /// The state of this rank's bell. Must be read before the rank checks for the events that the bell announces.
  [[nodiscard]] std::uint32_t heard() const;
  /// Returns when this rank's bell has rung since its state was `heard`, or after `most`.
  void wait(std::uint32_t heard, std::chrono::microseconds most);

 private:
  Bells(Transport& transport, PagesOfMachine shared);
  [[nodiscard]] std::atomic<std::uint32_t>& bell(int place) const;

  SharedPages pages_;
  std::vector<int> places_;  ///< the index of each rank among those of this machine; -1: on another machine
  int own_;
  bool of_all_;
};

}  // namespace tessera::exchange
