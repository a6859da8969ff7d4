// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <thread>

#include "exchange/transport.hpp"

namespace tessera::frame {

/// Passes stops between ranks: a request on one rank stops the run on all ranks.
///
/// Its messages contain the number of the run to stop. All ranks number the runs the same way. So a stop that arrives
/// after its run does not affect later runs, and a stop that arrives before its run is kept for it.
class StopRelay {
 public:
  explicit StopRelay(exchange::Transport& transport) : transport_(transport) {}

  /// Listens for stops during one run, which lasts as long as this object: a stop requested on any rank reaches
  /// token(). Collective: all ranks construct these objects in the same order.
  class Run {
   public:
    Run(StopRelay& relay, const std::stop_token& asked);
    ~Run();
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;

    [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }
    /// Stops the run on all ranks. May be called from any thread.
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
  std::uint64_t run_ = 0;      ///< number of the latest run
  std::uint64_t stopped_ = 0;  ///< number of the latest run for which a stop was received
};

}  // namespace tessera::frame
