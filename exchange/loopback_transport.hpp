// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "exchange/transport.hpp"

namespace tessera::exchange {

/// Ranks that are threads of one process, for tests and for trying a parallel job without MPI. Messages are moved, not
/// copied.
class LoopbackNetwork {
 public:
  explicit LoopbackNetwork(int ranks);
  ~LoopbackNetwork();

  [[nodiscard]] int size() const;
  [[nodiscard]] Transport& rank(int rank);

 private:
  class Rank;
  std::vector<std::unique_ptr<Rank>> ranks_;
  std::mutex fault_;
};

/// Runs `work(transport)` once per rank, each on its own thread, and returns when all have finished. An exception on
/// one rank ends the run for all, as under MPI; this function throws the run's error.
void run_ranks(int ranks, const std::function<void(Transport&)>& work);

}  // namespace tessera::exchange
