// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/mailboxes.hpp"

namespace tessera::exchange {

void Mailboxes::deliver(Channel channel, Message message) {
  const auto box = static_cast<std::size_t>(channel);
  {
    const std::lock_guard lock(mutex_);
    queues_[box].push_back(std::move(message));
  }
  arrived_[box].notify_one();
}

std::optional<Message> Mailboxes::receive(Channel channel, std::chrono::milliseconds timeout) {
  const auto box = static_cast<std::size_t>(channel);
  std::unique_lock lock(mutex_);
  arrived_[box].wait_for(lock, timeout, [&] { return error_ || !queues_[box].empty(); });
  if (error_) throw *error_;
  if (queues_[box].empty()) return std::nullopt;
  Message message = std::move(queues_[box].front());
  queues_[box].pop_front();
  return message;
}

void Mailboxes::fail(const scene::Error& error) {
  {
    const std::lock_guard lock(mutex_);
    if (error_) return;
    error_ = error;
    failed_.store(true, std::memory_order_release);
    for (auto& queue : queues_) queue.clear();
  }
  for (auto& arrived : arrived_) arrived.notify_all();
}

void Mailboxes::check() const {
  if (!failed()) return;
  const std::lock_guard lock(mutex_);
  throw scene::Error(*error_);
}

std::optional<scene::Error> Mailboxes::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

}  // namespace tessera::exchange
