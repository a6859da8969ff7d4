// SPDX-License-Identifier: BSD-3-Clause
// A compositor's bookkeeping of a frame, compared with a simple record of what was sent.
#include "exchange/frame_collector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>

#include "scene/error.hpp"

namespace tessera::exchange {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// One projector's messages of the frame, in order: a begin, parts, an end.
struct SentMessage {
  enum class Kind { begin, part, end } kind;
  TilePart part{};
};

/// A frame at compositor 0 of a random job.
struct Frame {
  Frame(std::uint64_t seed, bool large_parts)
      : random(seed),
        projectors(1 + static_cast<int>(seed % 4)),
        map(24, 2, seed),
        tiles(map.tiles(0)),
        contributes(static_cast<std::size_t>(projectors)),
        sent(static_cast<std::size_t>(projectors)),
        collector(projectors, map, 0) {
    for (std::size_t p = 0; p < sent.size(); ++p) {
      sent[p].push_back({SentMessage::Kind::begin});
      for (const std::uint32_t tile : tiles) {
        contributes[p].push_back(random() % 3 != 0);
        if (!contributes[p].back()) continue;
        double depth = 0;
        for (std::size_t left = 1 + random() % 5; left > 0; --left) {
          TilePart part;
          part.tile = tile;
          part.last = left == 1;
          depth += 1 + static_cast<double>(random() % 8);
          part.final_depth = part.last ? infinity : depth;
          part.fragments = ++parts;
          part.records = Bytes(large_parts ? 400 << 10 : 8 * (random() % 3));
          sent[p].push_back({SentMessage::Kind::part, part});
        }
      }
      if (end_goes_to(static_cast<int>(p), 2) == 0) sent[p].push_back({SentMessage::Kind::end});
    }
  }

  Bytes bits(std::size_t projector) const {
    Bytes bits((tiles.size() + 7) / 8, std::byte{0});
    for (std::size_t i = 0; i < tiles.size(); ++i)
      if (contributes[projector][i]) bits[i / 8] |= std::byte{1} << (i % 8);
    return bits;
  }

  std::mt19937_64 random;
  int projectors;
  TileMap map;
  const std::vector<std::uint32_t>& tiles;
  std::vector<std::vector<bool>> contributes;  ///< by projector and index of the tile
  std::vector<std::deque<SentMessage>> sent;
  FrameCollector collector;
  std::uint64_t parts = 0;
};

/// Receives a frame's messages in a random order that keeps the order of each projector, merges whenever there is work,
/// and checks the results. Returns how often a tile was merged before it was complete.
std::size_t expect_whole(std::uint64_t seed, bool large_parts) {
  Frame frame(seed, large_parts);
  FrameCollector& collector = frame.collector;
  std::map<std::uint32_t, double> complete_to;  // each tile is merged at least up to this depth
  // Tile of each part with records that has not been taken, by part number.
  std::map<std::uint64_t, std::uint32_t> pending;
  std::map<std::uint32_t, std::size_t> awaited;  // number of last parts that have not arrived, by tile
  for (std::size_t p = 0; p < frame.sent.size(); ++p)
    for (const SentMessage& sent : frame.sent[p])
      if (sent.kind == SentMessage::Kind::part && sent.part.last) ++awaited[sent.part.tile];
  std::size_t begins = 0;
  std::vector<std::uint64_t> owed(frame.sent.size()), paid(frame.sent.size());
  std::vector<std::uint32_t> finished;
  std::size_t early = 0;

  const auto merge = [&](std::uint32_t tile) {
    const FrameCollector::Waiting waiting = collector.take(tile);
    for (std::size_t i = 1; i < waiting.parts.size(); ++i)
      EXPECT_LE(waiting.parts[i - 1].start_depth, waiting.parts[i].start_depth) << "seed " << seed;
    for (const TilePart& part : waiting.parts) {
      // Nothing arrives in front of a depth declared complete, and no part twice.
      if (complete_to.contains(tile)) {
        EXPECT_GE(part.final_depth, complete_to[tile]);
      }
      EXPECT_EQ(pending.erase(part.fragments), 1u) << "seed " << seed;
    }
    if (complete_to.contains(tile)) {
      EXPECT_GE(waiting.final_depth, complete_to[tile]);
    }
    complete_to[tile] = waiting.final_depth;
    EXPECT_EQ(waiting.all, begins == frame.sent.size() && awaited[tile] == 0);
    if (!waiting.all) {
      ++early;
      return;
    }
    EXPECT_EQ(waiting.final_depth, infinity);
    for (const auto& [number, of_tile] : pending) EXPECT_NE(of_tile, tile) << "left behind, seed " << seed;
    collector.finish(tile);
    finished.push_back(tile);
    EXPECT_FALSE(collector.has_work(tile));
  };

  for (;;) {
    std::vector<std::size_t> senders;
    for (std::size_t p = 0; p < frame.sent.size(); ++p)
      if (!frame.sent[p].empty()) senders.push_back(p);
    if (senders.empty()) break;
    EXPECT_FALSE(collector.finished());
    const std::size_t p = senders[frame.random() % senders.size()];
    SentMessage sent = std::move(frame.sent[p].front());
    frame.sent[p].pop_front();
    if (sent.kind == SentMessage::Kind::begin) {
      ++begins;
      FrameBegin begin{};
      begin.tiles = frame.tiles.size();
      begin.longest_ray = static_cast<double>(p);
      collector.begin(static_cast<int>(p), begin, frame.bits(p));
      EXPECT_EQ(collector.has_all_begins(), begins == frame.sent.size());
    } else if (sent.kind == SentMessage::Kind::part) {
      const std::uint32_t tile = sent.part.tile;
      const std::uint64_t size = sent.part.records.size();
      if (size > 0) pending.emplace(sent.part.fragments, tile);
      if (sent.part.last) --awaited[tile];
      const double start = collector.add(static_cast<int>(p), std::move(sent.part));
      collector.owe(static_cast<int>(p), tile, start, size + 1);
      owed[p] += size + 1;
    } else {
      FrameEnd end{};
      end.counters.fragments = p + 1;
      collector.end(end);
    }
    for (const std::uint32_t tile : frame.tiles)
      if (collector.has_work(tile)) merge(tile);
    for (std::size_t q = 0; q < paid.size(); ++q) {
      paid[q] += collector.pay(static_cast<int>(q));
      EXPECT_LE(paid[q], owed[q]);
    }
  }
  // A tile becomes work as soon as it is complete. So all tiles are finished after the last message, and no credit is
  // outstanding.
  EXPECT_TRUE(collector.finished()) << "seed " << seed;
  EXPECT_TRUE(pending.empty()) << "seed " << seed;
  EXPECT_EQ(paid, owed) << "seed " << seed;
  EXPECT_EQ(std::set<std::uint32_t>(finished.begin(), finished.end()).size(), finished.size());
  EXPECT_EQ(collector.longest_ray(), frame.projectors - 1);
  std::uint64_t ended = 0;  // sum over projectors whose end messages arrive here
  for (int p = 0; p < frame.projectors; p += 2) ended += static_cast<std::uint64_t>(p + 1);
  EXPECT_EQ(collector.sums().counters.fragments, ended);
  return early;
}

TEST(FrameCollector, GivesEveryPartOnceInDepthOrderAndEndsWithNothingOwed) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) expect_whole(seed, false);
}

TEST(FrameCollector, MergesLargeTilesBeforeTheyAreComplete) {
  std::size_t early = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) early += expect_whole(seed, true);
  EXPECT_GT(early, 100u);
}

/// One projector and one of two compositors with its tiles.
struct OneProjector {
  TileMap map{8, 2, 1};
  FrameCollector collector{1, map, 0};
};

TEST(FrameCollector, CreditForATileThatIsNotItsFirstUnfinishedOneWaits) {
  OneProjector one;
  const auto& tiles = one.map.tiles(0);
  FrameBegin begin{};
  begin.tiles = tiles.size();
  const Bytes bits{std::byte{0b0111}};
  one.collector.begin(0, begin, bits);
  const auto add = [&](std::uint32_t tile) {
    TilePart part;
    part.tile = tile;
    part.last = true;
    part.final_depth = infinity;
    part.records = Bytes(10);
    one.collector.owe(0, tile, one.collector.add(0, std::move(part)), 10);
  };
  add(tiles[1]);
  EXPECT_EQ(one.collector.pay(0), 0u);
  add(tiles[0]);
  EXPECT_EQ(one.collector.pay(0), 10u);  // the first one's
  one.collector.take(tiles[1]);
  one.collector.finish(tiles[1]);
  EXPECT_EQ(one.collector.pay(0), 0u);  // tiles[1] is finished, but the earlier tiles[0] is not
  one.collector.take(tiles[0]);
  one.collector.finish(tiles[0]);
  EXPECT_EQ(one.collector.pay(0), 10u);
  add(tiles[2]);
  EXPECT_EQ(one.collector.pay(0), 10u);
}

TEST(FrameCollector, RefusesAnotherNumberOfTilesAndTilesOfOthers) {
  OneProjector one;
  FrameBegin begin{};
  begin.tiles = 5;
  EXPECT_THROW(one.collector.begin(0, begin, Bytes(1)), scene::Error);
  begin.tiles = std::numeric_limits<std::uint64_t>::max();
  EXPECT_THROW(one.collector.begin(0, begin, {}), scene::Error);
  TilePart part;
  part.tile = one.map.tiles(1).front();
  EXPECT_THROW(one.collector.add(0, part), scene::Error);
  part.tile = 1000;
  EXPECT_THROW(one.collector.add(0, part), scene::Error);
}

}  // namespace
}  // namespace tessera::exchange
