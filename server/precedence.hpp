// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <utility>

#include "tessera/sink.hpp"

namespace tessera::server {

/// Gives short work (views of clients) precedence over long work (images, films) that runs at the same time on other
/// threads: long work pauses between the tiles of a frame. Even if short work never ends, long work gets a quarter of
/// the time.
class Precedence {
 public:
  using Clock = std::chrono::steady_clock;

  /// These functions are called before and after short work, on one thread.
  void begin_short(Clock::time_point now);
  void end_short(Clock::time_point now);
  /// Called by threads of long work. Waits while short work has precedence; returns at once if `stop` is requested.
  void pass(const std::stop_token& stop);
  [[nodiscard]] bool is_held() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  bool held_ = false;
  Clock::duration credit_ = most_credit;  ///< remaining time for which short work may delay long work
  Clock::time_point since_{};             ///< time of the last change of `held_`

  static constexpr Clock::duration most_credit = std::chrono::seconds(3);
  static constexpr int earned = 3;  ///< credit gained per unit of time in which long work is not delayed
};

/// Calls `on_tile` with each tile of a frame and then waits while short work has precedence.
class YieldingSink final : public Sink {
 public:
  YieldingSink(Precedence& precedence, std::stop_token stop, std::function<void(const Tile&)> on_tile)
      : precedence_(precedence), stop_(std::move(stop)), on_tile_(std::move(on_tile)) {}
  void tile(const Tile& tile) override {
    on_tile_(tile);
    precedence_.pass(stop_);
  }

 private:
  Precedence& precedence_;
  std::stop_token stop_;
  std::function<void(const Tile&)> on_tile_;
};

}  // namespace tessera::server
