// SPDX-License-Identifier: BSD-3-Clause
#include "server/work_queue.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace tessera::server {
namespace {

class NoChannel final : public Channel {
 public:
  void send_text(std::string text) override { texts.push_back(std::move(text)); }
  void send_frame(std::string /*head*/, SharedBytes /*image*/) override {}
  void close() override {}
  std::vector<std::string> texts;
};

StateMessage state(std::uint64_t number, bool moving) { return {number, moving, Json::object()}; }

/// The next frame, which must exist.
FrameOrder take_frame(WorkQueue& queue) { return std::get<FrameOrder>(*queue.next()); }

FrameOutcome sent(Level level) { return {FrameOutcome::Kind::sent, level, 10}; }

/// Whether next() would wait.
bool is_idle(WorkQueue& queue) {
  class Probe final : public Task {
   public:
    Turn turn() override { return Turn::done; }
    void abandon() override {}
  };
  const auto probe = std::make_shared<Probe>();
  queue.add(probe);
  for (int i = 0; i < 2; ++i) {
    auto work = queue.next();
    if (!std::holds_alternative<std::shared_ptr<Task>>(*work)) return false;
    if (i == 0) queue.add(probe);
  }
  return true;
}

TEST(WorkQueue, RendersTheFullThenTheExactImageAndThenRests) {
  WorkQueue queue(100);
  const ClientId client = queue.join(std::make_shared<NoChannel>());
  queue.set_state(client, state(1, false));
  for (const Level level : {Level::automatic, Level::exact}) {
    const FrameOrder order = take_frame(queue);
    EXPECT_EQ(order.level, level);
    queue.begin_sending(order, 5);
    queue.finish(order, sent(level));
    EXPECT_TRUE(is_idle(queue));  // until the client has painted the frame
    queue.acknowledge(client, 4);
    EXPECT_TRUE(is_idle(queue));
    queue.acknowledge(client, 5);
  }
  EXPECT_TRUE(is_idle(queue));
}

TEST(WorkQueue, StopsFramesOfOldStatesButThoseThatMove) {
  WorkQueue queue(100);
  const ClientId client = queue.join(std::make_shared<NoChannel>());
  queue.set_state(client, state(1, false));
  FrameOrder order = take_frame(queue);
  queue.set_state(client, state(2, true));
  EXPECT_TRUE(order.stop.stop_requested());
  queue.finish(order, {FrameOutcome::Kind::stopped, Level::automatic, 0});
  order = take_frame(queue);
  EXPECT_EQ(order.level, Level::moving);
  EXPECT_EQ(order.number, 2u);
  queue.set_state(client, state(3, true));
  EXPECT_FALSE(order.stop.stop_requested());
  queue.set_state(client, state(2, false));  // late: has no effect
  queue.begin_sending(order, 1);
  queue.finish(order, sent(Level::moving));
  queue.acknowledge(client, 1);
  EXPECT_EQ(take_frame(queue).number, 3u);
}

TEST(WorkQueue, KeepsOneFrameAClientInWorkHoweverManyStatesCome) {
  WorkQueue queue(100);
  const ClientId client = queue.join(std::make_shared<NoChannel>());
  for (std::uint64_t number = 1; number <= 500; ++number) queue.set_state(client, state(number, true));
  const FrameOrder order = take_frame(queue);
  EXPECT_EQ(order.number, 500u);
  EXPECT_TRUE(is_idle(queue));
}

TEST(WorkQueue, TakesClientsInTurn) {
  WorkQueue queue(100);
  std::vector<ClientId> clients;
  for (int i = 0; i < 3; ++i) clients.push_back(queue.join(std::make_shared<NoChannel>()));
  std::vector<int> frames(3);
  for (std::uint64_t round = 1; round <= 30; ++round) {
    for (const ClientId client : clients) queue.set_state(client, state(round, true));
    const FrameOrder order = take_frame(queue);
    ++frames[order.client - clients.front()];
    queue.begin_sending(order, round);
    queue.finish(order, sent(Level::moving));
    queue.acknowledge(order.client, round);
  }
  EXPECT_EQ(frames, (std::vector<int>{10, 10, 10}));
}

TEST(WorkQueue, WaitsForDataEvenIfItArrivedInTheMeantime) {
  WorkQueue queue(100);
  const ClientId client = queue.join(std::make_shared<NoChannel>());
  queue.set_state(client, state(1, false));
  FrameOrder order = take_frame(queue);
  queue.finish(order, {FrameOutcome::Kind::waits_for_data, Level::automatic, 0});
  EXPECT_TRUE(is_idle(queue));
  queue.wake();
  order = take_frame(queue);
  queue.wake();  // before the queue knows that the order waits
  queue.finish(order, {FrameOutcome::Kind::waits_for_data, Level::automatic, 0});
  EXPECT_EQ(take_frame(queue).number, 1u);
}

TEST(WorkQueue, LeavesFailedStatesAndPausedClientsAlone) {
  WorkQueue queue(100);
  const ClientId client = queue.join(std::make_shared<NoChannel>());
  queue.set_state(client, state(1, false));
  FrameOrder order = take_frame(queue);
  queue.finish(order, {FrameOutcome::Kind::failed, Level::automatic, 0});
  EXPECT_TRUE(is_idle(queue));
  queue.set_state(client, state(2, false));
  order = take_frame(queue);
  queue.pause(client);
  EXPECT_TRUE(order.stop.stop_requested());
  queue.finish(order, {FrameOutcome::Kind::stopped, Level::automatic, 0});
  EXPECT_TRUE(is_idle(queue));
  queue.set_state(client, state(3, false));
  EXPECT_EQ(take_frame(queue).number, 3u);
}

TEST(WorkQueue, StopsTheWorkOfAClientThatLeaves) {
  WorkQueue queue(100);
  const ClientId client = queue.join(std::make_shared<NoChannel>());
  queue.set_state(client, state(1, false));
  const FrameOrder order = take_frame(queue);
  queue.leave(client);
  EXPECT_TRUE(order.stop.stop_requested());
  queue.finish(order, sent(Level::automatic));
  EXPECT_TRUE(is_idle(queue));
}

TEST(WorkQueue, StopsTheCurrentTaskWhenItEnds) {
  class Stopped final : public Task {
   public:
    Turn turn() override { return Turn::again; }
    void abandon() override { abandoned = true; }
    void stop() override { stopped = true; }
    bool stopped = false, abandoned = false;
  };
  WorkQueue queue(100);
  const auto task = std::make_shared<Stopped>();
  queue.add(task);
  auto work = queue.next();
  queue.end();
  EXPECT_TRUE(task->stopped);
  EXPECT_FALSE(task->abandoned);  // the task still has its turn and may answer
  queue.finish(std::get<std::shared_ptr<Task>>(*work), Task::Turn::again);
  EXPECT_TRUE(task->abandoned);
}

TEST(WorkQueue, EndsAtOnceAndAbandonsItsTasks) {
  class Waiting final : public Task {
   public:
    Turn turn() override { return Turn::done; }
    void abandon() override { abandoned = true; }
    bool abandoned = false;
  };
  WorkQueue queue(100);
  const auto before = std::make_shared<Waiting>(), after = std::make_shared<Waiting>();
  queue.add(before);
  queue.end();
  EXPECT_TRUE(before->abandoned);
  EXPECT_FALSE(queue.next().has_value());
  queue.add(after);
  EXPECT_TRUE(after->abandoned);
  WorkQueue other(100);
  std::thread ends([&] { other.end(); });
  EXPECT_FALSE(other.next().has_value());
  ends.join();
}

}  // namespace
}  // namespace tessera::server
