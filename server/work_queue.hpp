// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <variant>

#include "server/level_choice.hpp"
#include "server/messages.hpp"
#include "server/service.hpp"

namespace tessera::server {

enum class Level { moving, automatic, exact };
const char* level_name(Level level);

using Clock = std::chrono::steady_clock;

/// A frame to render for a client.
struct FrameOrder {
  ClientId client = 0;
  std::shared_ptr<Channel> channel;
  Json state;
  std::uint64_t number = 0;
  Level level = Level::moving;
  std::size_t shrink = 0;   ///< moving: index into `shrinks`
  bool preview = false;     ///< moving: shows the preview, as the data take too long
  Clock::time_point event;  ///< when the state arrived
  std::stop_source stop;    ///< requests a stop when the client has another state
};

/// Work for a request, done in turns.
class Task {
 public:
  enum class Turn { done, again, waits_for_data };
  virtual ~Task() = default;
  Task() = default;
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;
  virtual Turn turn() = 0;
  /// No turn follows: the server ends.
  virtual void abandon() = 0;
  /// Ends the current turn soon; may be called from any thread.
  virtual void stop() {}
};

/// The result of a frame.
struct FrameOutcome {
  enum class Kind { sent, stopped, failed, waits_for_data };
  Kind kind = Kind::failed;
  Level level = Level::moving;  ///< sent: the actual level, which may be more exact than requested
  double render_ms = 0;
};

/// Schedules the work: clients and tasks take turns, so that no client waits for another's second frame. Only the
/// latest state of a client counts. A frame of an older state is stopped at once if that state was at rest; a frame of
/// a moving state may finish, as a client that keeps moving would otherwise see none, unless it takes more than twice
/// its budget.
///
/// One thread does the work: only it calls next(), finish() and overdue(). All other functions may be called from any
/// thread.
class WorkQueue {
 public:
  explicit WorkQueue(double latency_ms) : latency_ms_(latency_ms) {}

  ClientId join(const std::shared_ptr<Channel>& channel);
  void leave(ClientId client);
  void set_state(ClientId client, StateMessage message);
  void acknowledge(ClientId client, std::uint64_t frame);
  void pause(ClientId client);
  void add(std::shared_ptr<Task> task);

  using Work = std::variant<FrameOrder, std::shared_ptr<Task>>;
  /// Waits for work. None once the queue has ended.
  std::optional<Work> next();
  /// Call before a frame is sent, as the client may acknowledge it at once.
  void begin_sending(const FrameOrder& order, std::uint64_t frame);
  void finish(const FrameOrder& order, const FrameOutcome& outcome);
  void finish(std::shared_ptr<Task> task, Task::Turn turn);
  /// Whether a moving frame has taken so long that a newer state should not wait for it.
  bool overdue(const FrameOrder& order);

  /// Data have arrived, or could not be read: clients and tasks that waited for them try again.
  void wake();
  void send(ClientId client, const std::string& text);
  /// Sends to all clients.
  void send_to_all(const std::string& text);
  /// Sends to clients that wait for data.
  void send_to_waiting(const std::string& text);
  /// After this call next() returns none; current work is asked to stop, and tasks are abandoned.
  void end();
  [[nodiscard]] bool ended();

 private:
  struct Client {
    Client(std::shared_ptr<Channel> to, double budget_ms) : channel(std::move(to)), levels(budget_ms) {}
    std::shared_ptr<Channel> channel;
    LevelChoice levels;
    std::optional<StateMessage> state;
    Clock::time_point event;
    std::optional<std::uint64_t> shown, failed;  ///< numbers of states
    Level shown_level = Level::moving;
    struct Sent {
      std::uint64_t frame;
      Level level;
      std::size_t shrink;
      bool preview;
      Clock::time_point event;
    };
    std::optional<Sent> unacknowledged;
    std::optional<std::stop_source> working;
    Level working_level = Level::moving;
    Clock::time_point working_since;
    bool paused = false, waits = false;
  };

  [[nodiscard]] static std::optional<Level> wanted(const Client& client);
  std::optional<FrameOrder> next_frame();

  const double latency_ms_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<ClientId, Client> clients_;
  ClientId last_client_ = 0, served_ = 0;
  std::deque<std::shared_ptr<Task>> tasks_, waiting_;
  std::shared_ptr<Task> working_;                    ///< the task that has its turn
  std::uint64_t wakes_ = 0, wakes_before_turn_ = 0;  ///< data may arrive while a task is about to wait for them
  bool tasks_turn_ = false, ended_ = false;
};

}  // namespace tessera::server
