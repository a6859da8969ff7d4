// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>

#include "exchange/message.hpp"
#include "scene/trace.hpp"

namespace tessera::exchange {

/// Queue between the threads that send messages and the thread that calls MPI.
class SendQueue {
 public:
  struct Outgoing {
    int to, tag;
    Bytes bytes;
    std::int32_t frame = -1;
  };

  void push(Outgoing message);
  [[nodiscard]] bool is_empty();

  /// Calls `send` with each queued message, in order.
  template <class Send>
  void hand_over(const Send& send) {
    std::deque<Outgoing> messages = take();
    for (Outgoing& message : messages) send(message);
    if (!messages.empty()) settle(posting_, false);
  }

  /// After this call, no queued message is passed on.
  void end() { settle(ended_, true); }

  /// Returns once all messages that were pushed earlier are recorded in the old traces.
  void trace_to(scene::Trace* projecting, scene::Trace* compositing);
  /// Returns a span for a message that is being passed to MPI, if traces show its channel: fragments, mesh or tiles.
  [[nodiscard]] scene::TraceScope traced(const Outgoing& message) const;

 private:
  std::deque<Outgoing> take();
  void settle(bool& state, bool value);

  std::mutex mutex_;
  std::condition_variable settled_;
  std::deque<Outgoing> queue_;
  bool posting_ = false;  ///< messages have left the queue, but are not passed to MPI yet
  bool ended_ = false;
  /// Changed only while no messages are being passed to MPI.
  scene::Trace *projecting_ = nullptr, *compositing_ = nullptr;
};

}  // namespace tessera::exchange
