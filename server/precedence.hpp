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

/// Lets short work (clients' views) go before long work (pictures, films) that runs at the same time on other threads:
/// the long work stands still meanwhile, from one tile of a frame to the next. Where short work never ends, long work
/// gets a quarter of the time all the same.
class Precedence {
 public:
  using Clock = std::chrono::steady_clock;

  /// Around short work, by one thread.
  void begin_short(Clock::time_point now);
  void end_short(Clock::time_point now);
  /// Of long work's threads: waits while short work goes first; returns at once when `stop` is asked for.
  void pass(const std::stop_token& stop);
  [[nodiscard]] bool is_held() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  bool held_ = false;
  Clock::duration credit_ = most_credit;  ///< for how long short work may hold up the long one
  Clock::time_point since_{};             ///< when `held_` last changed

  static constexpr Clock::duration most_credit = std::chrono::seconds(3);
  static constexpr int earned = 3;  ///< by so many times as long as it did not
};

/// Calls `on_tile` with each tile of a frame, then lets short work go first.
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
