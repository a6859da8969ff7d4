// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "exchange/transport.hpp"

namespace tessera::exchange {

/// Ranks that are threads of one process, for tests and for trying a job's shape without MPI. Messages are moved, not
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

/// Runs `work(transport)` once a rank, each on a thread of its own, and returns when all have. An exception of one rank
/// ends the run for all, as under MPI; the run's one error is thrown here.
void run_ranks(int ranks, const std::function<void(Transport&)>& work);

}  // namespace tessera::exchange
