// SPDX-License-Identifier: BSD-3-Clause
#include "server/work_queue.hpp"

#include <algorithm>
#include <utility>

namespace tessera::server {
namespace {

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Largest number of tasks that may wait for their turn or for data. Further tasks are abandoned on arrival.
constexpr std::size_t most_tasks = 256;

}  // namespace

const char* level_name(Level level) {
  return level == Level::moving ? "moving" : level == Level::automatic ? "auto" : "exact";
}

ClientId WorkQueue::join(const std::shared_ptr<Channel>& channel) {
  const std::lock_guard lock(mutex_);
  clients_.try_emplace(++last_client_, channel, latency_ms_);
  return last_client_;
}

void WorkQueue::leave(ClientId client) {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(client);
  if (found == clients_.end()) return;
  if (found->second.working) found->second.working->request_stop();
  clients_.erase(found);
}

void WorkQueue::set_state(ClientId client, StateMessage message) {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(client);
  if (found == clients_.end()) return;
  Client& c = found->second;
  if (c.state && message.number <= c.state->number) return;  // an older message that arrived late
  c.state = std::move(message);
  c.event = Clock::now();
  c.paused = c.waits = false;
  if (c.working && (c.working_level != Level::moving || ms_since(c.working_since) > 2 * latency_ms_))
    c.working->request_stop();
  changed_.notify_one();
}

void WorkQueue::acknowledge(ClientId client, std::uint64_t frame) {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(client);
  if (found == clients_.end()) return;
  Client& c = found->second;
  if (!c.unacknowledged || c.unacknowledged->frame != frame) return;
  if (c.unacknowledged->level == Level::moving)
    c.levels.took(c.unacknowledged->shrink, c.unacknowledged->preview, ms_since(c.unacknowledged->event));
  c.unacknowledged.reset();
  changed_.notify_one();
}

void WorkQueue::pause(ClientId client) {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(client);
  if (found == clients_.end()) return;
  found->second.paused = true;
  if (found->second.working) found->second.working->request_stop();
}

void WorkQueue::add(std::shared_ptr<Task> task) {
  {
    const std::lock_guard lock(mutex_);
    if (!ended_ && tasks_.size() + waiting_.size() < most_tasks) {
      tasks_.push_back(std::move(task));
      changed_.notify_one();
      return;
    }
  }
  task->abandon();
}

std::optional<Level> WorkQueue::wanted(const Client& client) {
  if (!client.state || client.paused || client.waits || client.unacknowledged || client.working) return std::nullopt;
  const std::uint64_t number = client.state->number;
  if (client.failed == number) return std::nullopt;
  if (client.shown != number) return client.state->moving ? Level::moving : Level::automatic;
  if (client.state->moving || client.shown_level == Level::exact) return std::nullopt;
  return client.shown_level == Level::moving ? Level::automatic : Level::exact;
}

std::optional<FrameOrder> WorkQueue::next_frame() {
  if (clients_.empty()) return std::nullopt;
  auto at = clients_.upper_bound(served_);
  for (std::size_t i = 0; i < clients_.size(); ++i, ++at) {
    if (at == clients_.end()) at = clients_.begin();
    Client& c = at->second;
    const std::optional<Level> level = wanted(c);
    if (!level) continue;
    served_ = at->first;
    FrameOrder order;
    order.client = at->first;
    order.channel = c.channel;
    order.state = c.state->state;
    order.number = c.state->number;
    order.level = *level;
    order.shrink = c.levels.shrink();
    order.preview = c.levels.wants_preview();
    order.event = c.event;
    c.working = order.stop;
    c.working_level = *level;
    c.working_since = Clock::now();
    return order;
  }
  return std::nullopt;
}

std::optional<WorkQueue::Work> WorkQueue::next() {
  std::unique_lock lock(mutex_);
  while (!ended_) {
    wakes_before_turn_ = wakes_;
    tasks_turn_ = !tasks_turn_;
    for (const bool task : {tasks_turn_, !tasks_turn_}) {
      if (task && !tasks_.empty()) {
        auto first = std::move(tasks_.front());
        tasks_.pop_front();
        working_ = first;
        return first;
      }
      if (task) continue;
      if (auto order = next_frame()) return std::move(*order);
    }
    changed_.wait(lock);
  }
  return std::nullopt;
}

void WorkQueue::begin_sending(const FrameOrder& order, std::uint64_t frame) {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(order.client);
  if (found == clients_.end()) return;
  found->second.unacknowledged = Client::Sent{frame, order.level, order.shrink, order.preview, order.event};
}

void WorkQueue::finish(const FrameOrder& order, const FrameOutcome& outcome) {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(order.client);
  if (found == clients_.end()) return;
  Client& c = found->second;
  c.working.reset();
  using Kind = FrameOutcome::Kind;
  if (outcome.kind == Kind::sent) {
    c.shown = order.number;
    c.shown_level = outcome.level;
    if (outcome.level == Level::automatic) c.levels.full_took(outcome.render_ms);
  } else if (outcome.kind == Kind::failed) {
    c.failed = order.number;
  } else if (outcome.kind == Kind::waits_for_data) {
    // A state that has arrived since the turn began may need other data.
    c.waits = c.state && c.state->number == order.number && wakes_ == wakes_before_turn_;
  } else if (order.level == Level::moving) {
    c.levels.took(order.shrink, order.preview, 1.5 * ms_since(c.working_since));
  }
}

void WorkQueue::finish(std::shared_ptr<Task> task, Task::Turn turn) {
  {
    const std::lock_guard lock(mutex_);
    working_.reset();
    if (turn == Task::Turn::done) return;
    if (!ended_) {
      const bool waits = turn == Task::Turn::waits_for_data && wakes_ == wakes_before_turn_;
      (waits ? waiting_ : tasks_).push_back(std::move(task));
      return;
    }
  }
  task->abandon();
}

bool WorkQueue::overdue(const FrameOrder& order) {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(order.client);
  if (found == clients_.end() || order.level != Level::moving || order.shrink + 1 == shrinks.size()) return false;
  return found->second.state->number > order.number && ms_since(found->second.working_since) > 2 * latency_ms_;
}

void WorkQueue::wake() {
  const std::lock_guard lock(mutex_);
  ++wakes_;
  for (auto& [id, client] : clients_) client.waits = false;
  tasks_.insert(tasks_.end(), waiting_.begin(), waiting_.end());
  waiting_.clear();
  changed_.notify_one();
}

void WorkQueue::send(ClientId client, const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (const auto found = clients_.find(client); found != clients_.end()) found->second.channel->send_text(text);
}

void WorkQueue::send_to_all(const std::string& text) {
  const std::lock_guard lock(mutex_);
  for (const auto& [id, client] : clients_) client.channel->send_text(text);
}

void WorkQueue::send_to_waiting(const std::string& text) {
  const std::lock_guard lock(mutex_);
  for (const auto& [id, client] : clients_)
    if (client.waits) client.channel->send_text(text);
}

void WorkQueue::end() {
  std::deque<std::shared_ptr<Task>> abandoned;
  std::shared_ptr<Task> working;
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    working = working_;
    for (auto& [id, client] : clients_)
      if (client.working) client.working->request_stop();
    abandoned.swap(tasks_);
    abandoned.insert(abandoned.end(), waiting_.begin(), waiting_.end());
    waiting_.clear();
    changed_.notify_one();
  }
  for (const auto& task : abandoned) task->abandon();
  if (working) working->stop();
}

bool WorkQueue::ended() {
  const std::lock_guard lock(mutex_);
  return ended_;
}

}  // namespace tessera::server
