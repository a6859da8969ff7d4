// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/mpi/send_queue.hpp"

#include <utility>

namespace tessera::exchange {

void SendQueue::push(Outgoing message) {
  const std::lock_guard lock(mutex_);
  queue_.push_back(std::move(message));
}

bool SendQueue::is_empty() {
  const std::lock_guard lock(mutex_);
  return queue_.empty();
}

std::deque<SendQueue::Outgoing> SendQueue::take() {
  const std::lock_guard lock(mutex_);
  posting_ = !queue_.empty();
  return std::exchange(queue_, {});
}

void SendQueue::settle(bool& state, bool value) {
  {
    const std::lock_guard lock(mutex_);
    state = value;
  }
  settled_.notify_all();
}

void SendQueue::trace_to(scene::Trace* projecting, scene::Trace* compositing) {
  std::unique_lock lock(mutex_);
  settled_.wait(lock, [&] { return (queue_.empty() && !posting_) || ended_; });
  projecting_ = projecting;
  compositing_ = compositing;
}

scene::TraceScope SendQueue::traced(const Outgoing& message) const {
  scene::Trace* trace = nullptr;
  if (message.tag == static_cast<int>(Channel::fragments) || message.tag == static_cast<int>(Channel::mesh))
    trace = projecting_;
  if (message.tag == static_cast<int>(Channel::tiles)) trace = compositing_;
  return {trace, "send", message.frame, message.bytes.size(), 1, message.to};
}

}  // namespace tessera::exchange
