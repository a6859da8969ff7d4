// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <thread>

#include "exchange/transport.hpp"

namespace tessera::frame {

/// Carries a stop between ranks: asked for on one, it stops all.
///
/// Its messages carry the number of the run that is to stop. Runs are numbered alike on all ranks, so that a stop which
/// comes too late stops nothing else, and one that comes early is kept for its run.
class StopRelay {
 public:
  explicit StopRelay(exchange::Transport& transport) : transport_(transport) {}

  /// While it lives, one run: stops from any rank reach token(). Collective, in the sense that all ranks make one in
  /// the same order.
  class Run {
   public:
    Run(StopRelay& relay, const std::stop_token& asked);
    ~Run();
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;

    [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }
    /// Stops the run on all ranks. Any thread.
    void stop();

   private:
    void listen();

    StopRelay& relay_;
    std::stop_source stop_;
    std::thread listener_;
    std::optional<std::stop_callback<std::function<void()>>> asked_;  // last: it may call stop() at once
  };

 private:
  exchange::Transport& transport_;
  std::uint64_t run_ = 0;      ///< of the latest
  std::uint64_t stopped_ = 0;  ///< the latest run of which a stop has come
};

}  // namespace tessera::frame
