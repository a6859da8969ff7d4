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
  std::size_t shrink = 0;   ///< while moving: index into `shrinks`
  bool preview = false;     ///< while moving: whether the frame shows the preview, because the data take too long
  Clock::time_point event;  ///< when the state arrived
  std::stop_source stop;    ///< a stop is requested when the client has another state
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
  /// Called if no further turn follows because the server ends.
  virtual void abandon() = 0;
  /// Makes the current turn end soon. May be called from any thread.
  virtual void stop() {}
};

/// The result of a frame.
struct FrameOutcome {
  enum class Kind { sent, stopped, failed, waits_for_data };
  Kind kind = Kind::failed;
  Level level = Level::moving;  ///< for a frame that was sent: its actual level, which may be more exact than requested
  double render_ms = 0;
};

/// Schedules the work: clients and tasks take turns, so that no client waits for the second frame of another client.
/// Only the latest state of a client is used. A frame of an older state is stopped at once if that state was at rest. A
/// frame of a moving state may finish unless it takes more than twice its budget, because a client that keeps moving
/// would otherwise receive no frames.
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
  /// Waits for work. Returns none after the queue has ended.
  std::optional<Work> next();
  /// Must be called before a frame is sent, since the client may acknowledge the frame at once.
  void begin_sending(const FrameOrder& order, std::uint64_t frame);
  void finish(const FrameOrder& order, const FrameOutcome& outcome);
  void finish(std::shared_ptr<Task> task, Task::Turn turn);
  /// Whether a moving frame has taken so long that a newer state should not wait for it.
  bool overdue(const FrameOrder& order);

  /// Called when data have arrived or could not be read. Clients and tasks that waited for data try again.
  void wake();
  void send(ClientId client, const std::string& text);
  /// Sends a text to all clients.
  void send_to_all(const std::string& text);
  /// Sends a text to the clients that wait for data.
  void send_to_waiting(const std::string& text);
  /// Ends the queue: next() returns none, a stop of current work is requested, and tasks are abandoned.
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
  std::shared_ptr<Task> working_;                    ///< the task whose turn it is
  std::uint64_t wakes_ = 0, wakes_before_turn_ = 0;  ///< data may arrive while a task is about to wait for them
  bool tasks_turn_ = false, ended_ = false;
};

}  // namespace tessera::server
