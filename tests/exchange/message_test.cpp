// SPDX-License-Identifier: BSD-3-Clause
// Messages: reading returns what was written, and refuses anything that is not a message.
#include "exchange/message.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>
#include <string>

#include "exchange/collectives.hpp"
#include "exchange/loopback_transport.hpp"
#include "scene/error.hpp"

namespace tessera::exchange {
namespace {

/// The error that `read` throws, or "" if it throws none. Anything but an Error(system_failure) fails the test.
template <class Read>
std::string refusal(const Read& read) {
  try {
    read();
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
    EXPECT_EQ(error.remedy(), "all ranks must run the same program");
    return std::string(error.problem());
  }
  return "";
}

struct Point {
  double x;
  std::uint32_t number;
  float weight;
  bool operator==(const Point&) const = default;
};

/// Random values for everything that a message may contain.
struct Contents {
  std::uint16_t small;
  double real;
  Point point;
  std::vector<std::uint64_t> list;
  std::vector<float> values;
  std::string text;
  bool operator==(const Contents&) const = default;
};

Contents random_contents(std::mt19937_64& random) {
  const auto size = [&] { return std::uniform_int_distribution<std::size_t>(0, 9)(random); };
  Contents contents{static_cast<std::uint16_t>(random()),
                    std::uniform_real_distribution<double>(-1, 1)(random),
                    {1e-300, static_cast<std::uint32_t>(random()), -0.0f},
                    {},
                    {},
                    {}};
  contents.list.resize(size());
  for (auto& value : contents.list) value = random();
  contents.values.resize(size());
  for (auto& value : contents.values) value = std::uniform_real_distribution<float>(-9, 9)(random);
  contents.text.resize(size());
  for (auto& letter : contents.text) letter = static_cast<char>(random());
  return contents;
}

Bytes written(const Contents& contents) {
  Bytes message = begin_message(MessageKind::mesh_description);
  append(message, contents.small);
  append(message, contents.real);
  append(message, contents.point);
  append_list(message, contents.list);
  append_text(message, contents.text);
  append(message, std::uint64_t{contents.values.size()});
  append_values(message, contents.values);
  return message;
}

Contents read(std::span<const std::byte> message) {
  MessageReader reader(message, 3, MessageKind::mesh_description);
  Contents contents{};
  contents.small = reader.take<std::uint16_t>();
  contents.real = reader.take<double>();
  contents.point = reader.take<Point>();
  contents.list = reader.take_list<std::uint64_t>();
  contents.text = reader.take_text();
  reader.take_onto(contents.values, reader.take<std::uint64_t>());
  reader.finish();
  return contents;
}

TEST(Message, GivesBackWhatWasWritten) {
  std::mt19937_64 random(20261123);
  for (int i = 0; i < 500; ++i) {
    const Contents contents = random_contents(random);
    EXPECT_EQ(read(written(contents)), contents) << i;
  }
}

TEST(Message, IsLittleEndianWithoutGapsBehindItsHeader) {
  Bytes message = begin_message(MessageKind::stop);
  append(message, std::uint16_t{0x0102});
  append_text(message, "ab");
  const std::vector<int> expected{0x54, 0x53, 0x53, 0x57, wire_version, 0,  9, 0, 0x02, 0x01, 2, 0, 0, 0,
                                  0,    0,    0,    0,    'a',          'b'};
  ASSERT_EQ(message.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(std::to_integer<int>(message[i]), expected[i]) << i;
}

TEST(Message, CutAnywhereOrTooLongIsRefused) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 50; ++i) {
    Bytes message = written(random_contents(random));
    for (std::size_t size = 0; size < message.size(); ++size)
      EXPECT_EQ(refusal([&] { read(std::span(message).first(size)); }),
                "a message from rank 3 is shorter than it states")
          << size << " of " << message.size();
    message.push_back(std::byte{0});
    EXPECT_EQ(refusal([&] { read(message); }), "a message from rank 3 is longer than it states");
  }
}

TEST(Message, OfAnotherVersionKindOrOriginIsRefusedInWords) {
  const Bytes message = message_of(MessageKind::credit, std::uint64_t{5});
  const auto changed = [&](std::size_t at) {
    Bytes other = message;
    other[at] ^= std::byte{1};
    return refusal([&] { value_of<std::uint64_t>(other, 2, MessageKind::credit); });
  };
  EXPECT_EQ(value_of<std::uint64_t>(message, 2, MessageKind::credit), 5u);
  for (std::size_t at = 0; at < 4; ++at) EXPECT_EQ(changed(at), "a message from rank 2 has an unknown wire version");
  EXPECT_EQ(changed(4), "a message from rank 2 has wire version " + std::to_string(wire_version ^ 1) +
                            ", but this rank uses version " + std::to_string(wire_version));
  EXPECT_EQ(changed(6), "a message from rank 2 is of kind 5, but kind 4 was expected");
  EXPECT_EQ(refusal([&] { value_of<std::uint32_t>(message, 2, MessageKind::credit); }),
            "a message from rank 2 is longer than it states");
}

TEST(Message, HostileLengthsAreRefusedBeforeAnythingIsAllocated) {
  // A vector of this size would throw std::bad_alloc or std::length_error, which refusal() does not catch; for the
  // smallest size that does not fit, the vector must stay unchanged.
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  for (const std::uint64_t length : {std::uint64_t{3}, std::uint64_t{1} << 31, std::uint64_t{1} << 40, most / 8 + 1,
                                     most / 8 + 3, most / 4 + 2, most - 7, most}) {
    Bytes message = message_of(MessageKind::reduction, length);
    append_values(message, std::vector<std::uint64_t>{1, 2});
    const auto refused = [&](const auto& take) {
      return refusal([&] {
        MessageReader reader(message, 1, MessageKind::reduction);
        take(reader);
      });
    };
    const std::string words = "a message from rank 1 is shorter than it states";
    EXPECT_EQ(refused([](auto& reader) { reader.template take_list<std::uint64_t>(); }), words) << length;
    if (length > 16) {
      EXPECT_EQ(refused([](auto& reader) { reader.take_text(); }), words) << length;
    }
    std::vector<std::uint64_t> kept{7};
    EXPECT_EQ(refused([&](auto& reader) { reader.take_onto(kept, reader.template take<std::uint64_t>()); }), words);
    EXPECT_EQ(kept, std::vector<std::uint64_t>{7});
    EXPECT_EQ(kept.capacity(), 1u);
  }
}

TEST(Message, NoBytesAtRandomCrashAReader) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 20000; ++i) {
    Bytes message = written(random_contents(random));
    for (int changes = 1 + i % 3; changes > 0; --changes)
      message[random() % message.size()] = static_cast<std::byte>(random());
    refusal([&] { read(message); });  // must be refused with a message, or be read as other values
  }
}

TEST(Collectives, ARankInAnotherCollectiveEndsTheRun) {
  try {
    run_ranks(3, [](Transport& transport) {
      if (transport.rank() == 2)
        gather_values(transport, MessageKind::seconds, 1.0);
      else
        barrier(transport);
    });
    FAIL() << "no error";
  } catch (const scene::Error& error) {
    EXPECT_STREQ(
        error.what(),
        "exchange: a message from rank 2 is of kind 35, but kind 16 was expected; all ranks must run the same program");
  }
}

TEST(Collectives, ARankOfAnotherVersionEndsTheRun) {
  try {
    run_ranks(2, [](Transport& transport) {
      if (transport.rank() == 0) return barrier(transport);
      Bytes message = begin_message(MessageKind::barrier);
      message[4] = std::byte{wire_version - 1};
      transport.send(0, Channel::agreement, std::move(message));
      transport.receive(Channel::agreement);
    });
    FAIL() << "no error";
  } catch (const scene::Error& error) {
    EXPECT_NE(std::string(error.what()).find("wire version " + std::to_string(wire_version - 1)), std::string::npos);
  }
}

}  // namespace
}  // namespace tessera::exchange
