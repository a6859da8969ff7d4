// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <string>

#include "exchange/collectives.hpp"
#include "exchange/first_contact.hpp"
#include "exchange/loopback_transport.hpp"

namespace tessera::exchange {
namespace {

Bytes bytes_of(const std::string& text) {
  Bytes bytes(text.size());
  if (!text.empty()) std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

std::string text_of(const Bytes& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

TEST(LoopbackTransport, KeepsTheOrderOfTwoRanksOnAChannelAndKeepsChannelsApart) {
  run_ranks(2, [](Transport& transport) {
    if (transport.rank() == 0) {
      for (int i = 0; i < 100; ++i) {
        transport.send(1, Channel::tiles, bytes_of("tile " + std::to_string(i)));
        transport.send(1, Channel::credit, bytes_of("credit " + std::to_string(i)));
      }
      EXPECT_EQ(transport.sent(Channel::tiles).messages, 100u);
      EXPECT_EQ(transport.sent(Channel::tiles).bytes, 10u * 6 + 90u * 7);
      EXPECT_EQ(transport.sent(Channel::mesh).messages, 0u);
    } else {
      for (int i = 0; i < 100; ++i)
        EXPECT_EQ(text_of(transport.receive(Channel::credit).bytes), "credit " + std::to_string(i));
      for (int i = 0; i < 100; ++i) {
        const Message message = transport.receive(Channel::tiles);
        EXPECT_EQ(message.from, 0);
        EXPECT_EQ(text_of(message.bytes), "tile " + std::to_string(i));
      }
    }
  });
}

TEST(LoopbackTransport, ReturnsNothingAfterTheTimeout) {
  LoopbackNetwork network(1);
  EXPECT_FALSE(network.rank(0).receive(Channel::frames, std::chrono::milliseconds(1)).has_value());
}

TEST(LoopbackTransport, OneRanksErrorEndsAllWaitingRanksWithTheSameMessage) {
  std::atomic<int> ended = 0;
  try {
    run_ranks(4, [&](Transport& transport) {
      if (transport.rank() == 2) throw scene::bad_input("mesh.vtu: is empty; give another");
      try {
        transport.receive(Channel::fragments);
      } catch (const scene::Error& error) {
        EXPECT_STREQ(error.what(), "mesh.vtu: is empty; give another");
        ++ended;
        throw;
      }
    });
    FAIL() << "no error came out";
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.code(), scene::ErrorCode::bad_input);
    EXPECT_STREQ(error.what(), "mesh.vtu: is empty; give another");
  }
  EXPECT_EQ(ended, 3);
}

TEST(FirstContact, IsMadeByAnyNumberOfRanksAndLeavesNothingBehind) {
  for (const int ranks : {1, 2, 5})
    for (const int patience : {0, 60000})
      run_ranks(ranks, [&](Transport& transport) {
        make_first_contact(transport, std::chrono::milliseconds(patience));
        barrier(transport);
        EXPECT_FALSE(transport.receive(Channel::agreement, std::chrono::milliseconds(1)).has_value());
      });
}

TEST(FirstContact, FindsTheFirstArgumentInWhichARankDiffers) {
  using Words = std::vector<std::string>;
  const Words first{"render", "a", "-o", ""};
  struct Case {
    Words other;
    std::string message;
  };
  for (const Case& c : std::vector<Case>{
           {{"render", "b", "-o", ""}, "argument 2: rank 2 of 3 was given 'b' where the first rank was given 'a'"},
           {{"render", "a", "-o"}, "argument 4: rank 2 of 3 was given nothing where the first rank was given ''"},
           {{"render", "a", "-o", "", ""},
            "argument 5: rank 2 of 3 was given '' where the first rank was given nothing"}})
    try {
      run_ranks(3, [&](Transport& transport) {
        make_first_contact(transport, std::chrono::milliseconds(0), transport.rank() == 2 ? c.other : first);
      });
      ADD_FAILURE() << c.message;
    } catch (const scene::Error& error) {
      EXPECT_EQ(error.code(), scene::ErrorCode::bad_input);
      EXPECT_EQ(std::string(error.what()).find(c.message), 0u) << error.what();
    }
  run_ranks(3, [&](Transport& transport) { make_first_contact(transport, std::chrono::milliseconds(0), first); });
}

/// Loses messages of its rank from message `first` on, as Open MPI does if memory ran out at its start.
class Losing final : public Transport {
 public:
  Losing(Transport& whole, int first) : whole_(whole), first_(first) {}
  using Transport::receive;
  using Transport::send;
  [[nodiscard]] int rank() const override { return whole_.rank(); }
  [[nodiscard]] int size() const override { return whole_.size(); }
  void send(int to, Channel channel, Bytes bytes, std::int32_t frame) override {
    if (sent_++ < first_) whole_.send(to, channel, std::move(bytes), frame);
  }
  std::optional<Message> receive(Channel channel, std::chrono::milliseconds timeout) override {
    return whole_.receive(channel, timeout);
  }
  void fail(const scene::Error& error) override { whole_.fail(error); }
  void check() const override { whole_.check(); }
  void trace_to(scene::Trace* projecting, scene::Trace* compositing) override {
    whole_.trace_to(projecting, compositing);
  }
  [[nodiscard]] Traffic sent(Channel channel) const override { return whole_.sent(channel); }

 private:
  Transport& whole_;
  int first_, sent_ = 0;
};

TEST(FirstContact, EndsTheRunWhicheverMessageIsLost) {
  for (const int mute : {0, 1, 2})
    for (const int first : {0, 1}) {
      try {
        run_ranks(3, [&](Transport& transport) {
          Losing losing(transport, transport.rank() == mute ? first : 1000);
          make_first_contact(losing, std::chrono::milliseconds(300));
          barrier(losing);  // a rank without the error waits here for the others
        });
        ADD_FAILURE() << "rank " << mute << ", message " << first << ": nobody noticed";
      } catch (const scene::Error& error) {
        EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
        EXPECT_NE(std::string(error.what()).find("received nothing from"), std::string::npos) << error.what();
      }
    }
}

TEST(Collectives, GiveEveryRankTheSameInRankOrderFromAnyRoot) {
  for (const int ranks : {1, 2, 3, 8})
    run_ranks(ranks, [&](Transport& transport) {
      for (int round = 0; round < 50; ++round) {
        const int root = round % ranks;
        const std::string word = "from " + std::to_string(root) + " in round " + std::to_string(round);
        ASSERT_EQ(text_of(broadcast(transport, root, bytes_of(transport.rank() == root ? word : "not mine"))), word);
        ASSERT_EQ(broadcast_value(transport, root, MessageKind::seconds, 0.5 * transport.rank()), 0.5 * root);
        Bytes mine = begin_message(MessageKind::host);
        append_text(mine, std::string(static_cast<std::size_t>(transport.rank()), 'x'));
        const auto all = gather_all(transport, std::move(mine));
        ASSERT_EQ(all.size(), static_cast<std::size_t>(ranks));
        for (int rank = 0; rank < ranks; ++rank)
          ASSERT_EQ(MessageReader(all[static_cast<std::size_t>(rank)], rank, MessageKind::host).take_text().size(),
                    rank);
        barrier(transport);
      }
    });
}

}  // namespace
}  // namespace tessera::exchange
