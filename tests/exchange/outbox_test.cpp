// SPDX-License-Identifier: BSD-3-Clause
// A projector's outbox, with the test as its compositors: what arrives, in which order, and which threads wait.
#include "exchange/outbox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <tuple>

#include "exchange/loopback_transport.hpp"
#include "scene/error.hpp"
#include "support/await.hpp"

namespace tessera::exchange {
namespace {

using std::chrono::milliseconds;

/// How long the test waits for messages that must not arrive.
constexpr milliseconds moment(50);

/// A projector's transport that reports whether one of its threads waits for credit.
class Watched final : public Transport {
 public:
  explicit Watched(Transport& beneath) : beneath_(beneath) {}
  using Transport::receive;
  using Transport::send;
  [[nodiscard]] int rank() const override { return beneath_.rank(); }
  [[nodiscard]] int size() const override { return beneath_.size(); }
  void send(int to, Channel channel, Bytes bytes, std::int32_t frame) override {
    beneath_.send(to, channel, std::move(bytes), frame);
  }
  std::optional<Message> receive(Channel channel, milliseconds timeout) override {
    return beneath_.receive(channel, timeout);
  }
  void fail(const scene::Error& error) override { beneath_.fail(error); }
  void check() const override { beneath_.check(); }
  void set_working(bool working) override { waits_ = !working; }
  void trace_to(scene::Trace* projecting, scene::Trace* compositing) override {
    beneath_.trace_to(projecting, compositing);
  }
  [[nodiscard]] Traffic sent(Channel channel) const override { return beneath_.sent(channel); }

  [[nodiscard]] bool comes_to_wait() const {
    return test::await([this] { return waits_.load(); });
  }

 private:
  Transport& beneath_;
  std::atomic<bool> waits_ = false;
};

/// Rank 0 is the projector, the others are compositors.
struct Job {
  explicit Job(int compositors, std::uint64_t window, std::uint64_t backlog)
      : network(1 + compositors), projector(network.rank(0)), settings{{}, window, backlog} {
    for (int c = 0; c < compositors; ++c) settings.compositor_ranks.push_back(1 + c);
    received.resize(static_cast<std::size_t>(compositors));
  }

  /// Takes what has arrived at a compositor, one message or none; `pays`: returns the credit for its bytes.
  bool take(int compositor, bool pays, milliseconds patience = test::hang) {
    Transport& transport = network.rank(1 + compositor);
    const auto message = transport.receive(Channel::fragments, patience);
    if (!message) return false;
    if (pays) give_back(compositor, message->bytes.size());
    received[static_cast<std::size_t>(compositor)].push_back(message->bytes);
    return true;
  }
  void give_back(int compositor, std::uint64_t bytes) {
    network.rank(1 + compositor).send(0, Channel::credit, message_of(MessageKind::credit, bytes));
  }

  LoopbackNetwork network;
  Watched projector;
  Outbox::Settings settings;
  std::vector<std::vector<Bytes>> received;  ///< by compositor
};

Bytes records_of(std::uint32_t tile, std::size_t part, std::size_t size) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(31 * tile + 7 * part + i);
  return bytes;
}

TilePart part_of(std::uint32_t tile, std::size_t part, std::size_t size, bool last) {
  TilePart made;
  made.tile = tile;
  made.last = last;
  made.final_depth = static_cast<double>(part);
  made.fragments = size / 32;
  made.records = records_of(tile, part, size);
  return made;
}

/// A compositor's messages, decoded.
struct Summary {
  std::vector<MessageKind> kinds;
  FrameBegin begin{};
  std::vector<std::uint32_t> begun;  ///< indices, in the compositor's list, of tiles whose bit is set
  FrameEnd end{};
  std::vector<PartHeader> parts;
  std::map<std::uint32_t, Bytes> records;  ///< by tile
  std::uint64_t bytes = 0;
};

Summary summary_of(const std::vector<Bytes>& messages, std::uint32_t frame) {
  Summary summary;
  for (const Bytes& message : messages) {
    MessageReader reader(message, 0);
    EXPECT_EQ(reader.take<std::uint64_t>(), frame);
    summary.kinds.push_back(reader.kind());
    summary.bytes += message.size();
    if (reader.kind() == MessageKind::begin) {
      summary.begin = reader.take<FrameBegin>();
      const auto bits = reader.take_bytes((summary.begin.tiles + 7) / 8);
      for (std::uint32_t i = 0; i < summary.begin.tiles; ++i)
        if ((bits[i / 8] >> (i % 8) & std::byte{1}) != std::byte{0}) summary.begun.push_back(i);
    } else if (reader.kind() == MessageKind::end) {
      summary.end = reader.take<FrameEnd>();
    } else {
      while (!reader.empty()) {
        summary.parts.push_back(reader.take<PartHeader>());
        const auto bytes = reader.take_bytes(summary.parts.back().bytes);
        auto& records = summary.records[summary.parts.back().tile];
        records.insert(records.end(), bytes.begin(), bytes.end());
      }
    }
    reader.finish();
  }
  return summary;
}

TEST(Outbox, EveryPartArrivesOnceInTileOrderWhateverTheThreadsDo) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    std::mt19937_64 random(seed);
    const int compositors = 1 + static_cast<int>(seed % 3);
    constexpr std::uint32_t tiles = 40, frame = 7;
    // Windows of a few messages and a backlog of some parts, so that threads do wait.
    Job job(compositors, 300 << 10, 200 << 10);
    job.settings.projector = static_cast<int>(seed % 5);
    const TileMap map(tiles, compositors, seed);
    std::vector<bool> has_parts(tiles);
    std::vector<std::vector<std::size_t>> sizes(tiles);  // of each tile's parts
    std::uint64_t fragments = 0;
    for (std::uint32_t tile = 0; tile < tiles; ++tile) {
      has_parts[tile] = random() % 4 != 0;
      if (!has_parts[tile]) continue;
      for (std::size_t left = 1 + random() % 4; left > 0; --left)
        sizes[tile].push_back(32 * (left == 1 ? 0 : random() % 3000));
      for (const std::size_t size : sizes[tile]) fragments += size / 32;
    }
    std::atomic<int> ended = 0;
    std::atomic<bool> over = false;
    std::vector<std::thread> receivers;
    for (int c = 0; c < compositors; ++c)
      receivers.emplace_back([&, c] {
        auto& mine = job.received[static_cast<std::size_t>(c)];
        while (!over || job.take(c, true, milliseconds(0)))
          if (!over) job.take(c, true, milliseconds(100));
        if (MessageReader(mine.back(), 0).kind() == MessageKind::end) ++ended;
      });
    {
      Outbox outbox(job.projector, job.settings);
      outbox.begin_frame(frame, map, has_parts, {.longest_ray = 2.5, .tiles = 0, .longest_edge = 0.5f});
      std::atomic<std::uint32_t> next = 0;  // tiles begin in order, on three threads
      std::vector<std::thread> projectors;
      for (int thread = 0; thread < 3; ++thread)
        projectors.emplace_back([&] {
          for (std::uint32_t tile = next++; tile < tiles; tile = next++)
            for (std::size_t part = 0; part < sizes[tile].size(); ++part)
              outbox.put(part_of(tile, part, sizes[tile][part], part + 1 == sizes[tile].size()));
        });
      for (auto& projector : projectors) projector.join();
      FrameEnd sums{};
      sums.on_lattice = 1;
      outbox.end_frame(sums);  // everything has been sent
      over = true;
      for (auto& receiver : receivers) receiver.join();
    }
    ASSERT_EQ(ended, 1);

    FrameEnd total{};
    std::uint64_t bytes = 0, messages = 0;
    for (int c = 0; c < compositors; ++c) {
      const auto& mine = job.received[static_cast<std::size_t>(c)];
      const Summary summary = summary_of(mine, frame);
      const bool gets_end = c == end_goes_to(job.settings.projector, compositors);
      ASSERT_GE(summary.kinds.size(), gets_end ? 2u : 1u);
      EXPECT_EQ(summary.kinds.front(), MessageKind::begin);
      EXPECT_EQ(summary.kinds.back() == MessageKind::end, gets_end);
      EXPECT_EQ(std::count(summary.kinds.begin(), summary.kinds.end(), MessageKind::parts) + (gets_end ? 2 : 1),
                static_cast<std::ptrdiff_t>(summary.kinds.size()));
      EXPECT_EQ(summary.begin.longest_ray, 2.5);
      ASSERT_EQ(summary.begin.tiles, map.tiles(c).size());
      std::vector<std::uint32_t> begun;
      for (const std::uint32_t place : summary.begun) begun.push_back(map.tiles(c)[place]);
      std::vector<std::uint32_t> order;  // of the parts
      for (const PartHeader& part : summary.parts)
        if (order.empty() || order.back() != part.tile) order.push_back(part.tile);
      EXPECT_EQ(order, begun) << "seed " << seed;  // each expected tile once, in the compositor's order
      for (const std::uint32_t tile : begun) {
        Bytes expected;
        for (std::size_t part = 0; part < sizes[tile].size(); ++part) {
          const Bytes records = records_of(tile, part, sizes[tile][part]);
          expected.insert(expected.end(), records.begin(), records.end());
        }
        EXPECT_EQ(summary.records.at(tile), expected) << "tile " << tile << ", seed " << seed;
      }
      for (std::size_t i = 0; i < summary.parts.size(); ++i)
        EXPECT_EQ(summary.parts[i].last != 0,
                  i + 1 == summary.parts.size() || summary.parts[i + 1].tile != summary.parts[i].tile);
      total = sum(total, summary.end);
      bytes += summary.bytes;
      messages += mine.size();
    }
    // Counted once.
    EXPECT_EQ(total.counters.fragments, fragments);
    EXPECT_EQ(total.counters.exchange_bytes, bytes);
    EXPECT_EQ(total.counters.exchange_messages, messages);
    EXPECT_EQ(total.on_lattice, 1u);
  }
}

TEST(Outbox, SendsNoMoreThanTheWindowAheadAndGoesOnWithCredit) {
  constexpr std::uint64_t window = 600 << 10, part_bytes = 64 << 10, message_bytes = 256 << 10;
  Job job(1, window, 100 << 10);
  const TileMap map(2, 1, 1);
  Outbox outbox(job.projector, job.settings);
  outbox.begin_frame(0, map, {true, true}, {});
  constexpr std::size_t parts = 60;
  std::atomic<std::size_t> put = 0;
  auto projector = std::async(std::launch::async, [&] {
    for (; put < parts; ++put) outbox.put(part_of(0, put, part_bytes, false));
  });
  // No credit returns, so the projector stops after sending the window and at most one more message.
  ASSERT_TRUE(job.projector.comes_to_wait());
  const std::size_t stuck_at = put;
  EXPECT_LT(stuck_at, parts);
  std::uint64_t sent = 0;
  while (job.take(0, false, milliseconds(1))) sent += job.received[0].back().size();
  EXPECT_GE(sent, window - message_bytes);
  EXPECT_LE(sent, window + message_bytes + part_bytes + 1024);
  // Credit for one message allows about one more message.
  job.give_back(0, job.received[0].back().size());
  ASSERT_TRUE(job.take(0, false));
  EXPECT_FALSE(job.take(0, false, moment));
  EXPECT_EQ(projector.wait_for(milliseconds(0)), std::future_status::timeout);
  job.give_back(0, 1 << 30);
  std::thread receiver([&] {
    while (job.received[0].empty() || MessageReader(job.received[0].back(), 0).kind() != MessageKind::end)
      job.take(0, true, milliseconds(100));
  });
  projector.get();
  outbox.put(part_of(0, parts, 0, true));
  outbox.put(part_of(1, 0, 0, true));
  outbox.end_frame({});
  receiver.join();
  EXPECT_EQ(summary_of(job.received[0], 0).records.at(0).size(), parts * part_bytes);
}

TEST(Outbox, ALaterTileWaitsButTheFirstUnfinishedOneIsNotHeldUp) {
  Job job(1, 100 << 10, 50 << 10);
  const TileMap map(3, 1, 1);
  Outbox outbox(job.projector, job.settings);
  outbox.begin_frame(0, map, {true, true, true}, {});
  auto later = std::async(std::launch::async, [&] { outbox.put(part_of(2, 0, 200 << 10, true)); });
  ASSERT_TRUE(job.projector.comes_to_wait());  // the later tile must not run ahead
  // Although the backlog is full, tiles 0 and 1 proceed on their compositor's credit alone.
  auto first = std::async(std::launch::async, [&] {
    outbox.put(part_of(0, 0, 32, true));
    outbox.put(part_of(1, 0, 32, true));
  });
  EXPECT_EQ(first.wait_for(test::hang), std::future_status::ready);
  std::thread receiver([&] {
    while (job.received[0].empty() || MessageReader(job.received[0].back(), 0).kind() != MessageKind::end)
      job.take(0, true, milliseconds(100));
  });
  later.get();  // all earlier tiles have ended, so this tile is the first
  outbox.end_frame({});
  receiver.join();
  std::vector<std::uint32_t> order;
  for (const PartHeader& part : summary_of(job.received[0], 0).parts) order.push_back(part.tile);
  EXPECT_EQ(order, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(Outbox, TilesThatArePassedEndWithoutRecordsInTheirOrder) {
  Job job(1, 100 << 10, 50 << 10);
  const TileMap map(4, 1, 1);
  Outbox outbox(job.projector, job.settings);
  outbox.begin_frame(0, map, {true, true, true, true}, {});
  outbox.pass(1);
  outbox.put(part_of(2, 0, 64, true));
  outbox.put(part_of(0, 0, 32, false));
  outbox.flush();  // the message is not full, but it is sent
  ASSERT_TRUE(job.take(0, true));
  ASSERT_TRUE(job.take(0, true));
  outbox.put(part_of(0, 1, 32, true));
  outbox.pass(3);
  outbox.end_frame({});
  while (MessageReader(job.received[0].back(), 0).kind() != MessageKind::end) ASSERT_TRUE(job.take(0, true));
  const Summary summary = summary_of(job.received[0], 0);
  std::vector<std::tuple<std::uint32_t, std::uint64_t, bool>> parts;
  for (const PartHeader& part : summary.parts) parts.emplace_back(part.tile, part.bytes, part.last != 0);
  EXPECT_EQ(parts, (std::vector<std::tuple<std::uint32_t, std::uint64_t, bool>>{
                       {0, 32, false}, {0, 32, true}, {1, 0, true}, {2, 64, true}, {3, 0, true}}));
}

TEST(Outbox, AWaitingThreadHoldsBackNothing) {
  Job job(2, 100 << 10, 50 << 10);
  const TileMap map(2, 2, 1);
  Outbox outbox(job.projector, job.settings);
  outbox.begin_frame(0, map, {true, true}, {});
  outbox.put(part_of(0, 0, 320, false));  // much smaller than a message
  const int compositor = map.owner(0);
  ASSERT_TRUE(job.take(compositor, false));  // the begin message
  EXPECT_FALSE(job.take(compositor, false, moment));
  auto later = std::async(std::launch::async, [&] {
    for (std::size_t part = 0; part < 2; ++part)
      outbox.put(part_of(1, part, 400 << 10, false));  // more than the window
  });
  EXPECT_TRUE(job.take(compositor, false));
  job.network.rank(1).fail(scene::Error(scene::ErrorCode::system_failure, "over"));
  EXPECT_THROW(later.get(), scene::Error);
}

TEST(Outbox, AStoppedFrameEndsEveryOpenTileAndReportsIt) {
  Job job(2, 1 << 20, 1 << 20);
  const TileMap map(8, 2, 3);
  std::vector<bool> has_parts(8, true);
  has_parts[5] = false;
  {
    Outbox outbox(job.projector, job.settings);
    outbox.begin_frame(4, map, has_parts, {});
    outbox.put(part_of(0, 0, 64, true));
    outbox.put(part_of(3, 0, 64, false));  // begun, and not ended
    outbox.end_tiles();
    outbox.end_frame({});
  }
  std::map<std::uint32_t, int> last;  // contents of each tile's last part
  for (int c = 0; c < 2; ++c) {
    while (job.take(c, false, milliseconds(1))) {
    }
    for (const PartHeader& part : summary_of(job.received[static_cast<std::size_t>(c)], 4).parts)
      if (part.last != 0) {
        EXPECT_TRUE(last.emplace(part.tile, part.last).second);
      }
  }
  EXPECT_EQ(last, (std::map<std::uint32_t, int>{{0, 1}, {1, 2}, {2, 2}, {3, 2}, {4, 2}, {6, 2}, {7, 2}}));
}

TEST(Outbox, TheRunsErrorFreesAThreadThatWaits) {
  Job job(1, 1, 1);
  const TileMap map(2, 1, 1);
  Outbox outbox(job.projector, job.settings);
  outbox.begin_frame(0, map, {true, true}, {});
  auto projector = std::async(std::launch::async, [&] { outbox.put(part_of(1, 0, 1 << 20, true)); });
  ASSERT_TRUE(job.projector.comes_to_wait());
  job.network.rank(1).fail(scene::Error(scene::ErrorCode::system_failure, "rank 1 of 2: is gone; start again"));
  try {
    projector.get();
    FAIL() << "no error";
  } catch (const scene::Error& error) {
    EXPECT_STREQ(error.what(), "rank 1 of 2: is gone; start again");
  }
}

}  // namespace
}  // namespace tessera::exchange
