// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>

#include "exchange/transport.hpp"

namespace tessera::exchange {

/// The receiving side of every transport: one queue per channel, and the run's error.
class Mailboxes {
 public:
  void deliver(Channel channel, Message message);

  /// Same as Transport::receive.
  std::optional<Message> receive(Channel channel, std::chrono::milliseconds timeout);

  /// Wakes all receivers with this error; only the first error is kept.
  void fail(const scene::Error& error);
  void check() const;
  [[nodiscard]] bool failed() const { return failed_.load(std::memory_order_acquire); }
  [[nodiscard]] std::optional<scene::Error> error() const;

 private:
  mutable std::mutex mutex_;
  std::array<std::condition_variable, channel_count> arrived_;
  std::array<std::deque<Message>, channel_count> queues_;
  std::atomic<bool> failed_ = false;
  std::optional<scene::Error> error_;
};

/// Bytes and messages sent, by channel.
class TrafficCounters {
 public:
  void add(Channel channel, std::size_t bytes) {
    auto& counter = counters_[static_cast<std::size_t>(channel)];
    counter.bytes.fetch_add(bytes, std::memory_order_relaxed);
    counter.messages.fetch_add(1, std::memory_order_relaxed);
  }
  [[nodiscard]] Transport::Traffic of(Channel channel) const {
    const auto& counter = counters_[static_cast<std::size_t>(channel)];
    return {counter.bytes.load(std::memory_order_relaxed), counter.messages.load(std::memory_order_relaxed)};
  }

 private:
  struct Counter {
    std::atomic<std::uint64_t> bytes = 0, messages = 0;
  };
  std::array<Counter, channel_count> counters_;
};

}  // namespace tessera::exchange
