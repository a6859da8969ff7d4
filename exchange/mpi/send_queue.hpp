// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>

#include "exchange/message.hpp"
#include "scene/trace.hpp"

namespace tessera::exchange {

/// Messages between the threads that send them and the one that speaks MPI.
class SendQueue {
 public:
  struct Outgoing {
    int to, tag;
    Bytes bytes;
    std::int32_t frame = -1;
  };

  void push(Outgoing message);
  [[nodiscard]] bool is_empty();

  /// Calls `send` with each message that has been queued, in their order.
  template <class Send>
  void hand_over(const Send& send) {
    std::deque<Outgoing> messages = take();
    for (Outgoing& message : messages) send(message);
    if (!messages.empty()) settle(posting_, false);
  }

  /// Nothing is handed over any more: what is queued stays here.
  void end() { settle(ended_, true); }

  /// What was pushed before is on the old traces when this returns.
  void trace_to(scene::Trace* projecting, scene::Trace* compositing);
  /// A span of what a user asks about: fragments, meshes and tiles. For a message that is being handed over.
  [[nodiscard]] scene::TraceScope traced(const Outgoing& message) const;

 private:
  std::deque<Outgoing> take();
  void settle(bool& state, bool value);

  std::mutex mutex_;
  std::condition_variable settled_;
  std::deque<Outgoing> queue_;
  bool posting_ = false;  ///< messages are between the queue and MPI
  bool ended_ = false;
  scene::Trace *projecting_ = nullptr, *compositing_ = nullptr;  ///< changed while nothing is being posted
};

}  // namespace tessera::exchange
