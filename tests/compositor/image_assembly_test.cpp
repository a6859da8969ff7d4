// Tiles on their way from compositors to the picture.
#include "compositor/image_assembly.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "exchange/loopback_transport.hpp"
#include "scene/error.hpp"

namespace tessera::compositor {
namespace {

using exchange::Bytes;
using exchange::MessageKind;

constexpr scene::ImageSize size{70, 45};  // tiles at the rim are narrower
constexpr projection::TileGrid grid{size, 32};

/// A tile with pixels, and perhaps deep samples, drawn at random.
MergedTile random_tile(std::size_t tile, bool deep, std::mt19937& random) {
  const scene::PixelRect rect = grid.rect(tile);
  MergedTile made;
  made.image = scene::Image({rect.x1 - rect.x0, rect.y1 - rect.y0});
  std::uniform_real_distribution<float> uniform(0, 1);
  for (auto* values : {&made.image.rgba, &made.image.depth})
    for (float& value : *values) value = uniform(random);
  if (!deep) return made;
  for (std::int64_t p = 0; p < rect.area(); ++p) made.deep_counts.push_back(random() % 3);
  for (const std::uint32_t count : made.deep_counts)
    for (std::uint32_t k = 0; k < count; ++k)
      made.deep_samples.push_back({static_cast<float>(k), k + 0.5f, uniform(random), uniform(random), 0, 0.5f});
  return made;
}

/// A job of compositors 1 to n, whose tiles go to rank 0.
struct Job {
  explicit Job(int compositors) : network(1 + compositors) {
    for (int c = 0; c < compositors; ++c) sent.emplace_back();
  }
  TileSender sender(int compositor, std::uint32_t frame) { return {network.rank(1 + compositor), 0, frame}; }
  /// The messages that have come, by compositor.
  void collect() {
    while (auto message = network.rank(0).receive(exchange::Channel::tiles, std::chrono::milliseconds(1)))
      sent[static_cast<std::size_t>(message->from - 1)].push_back(std::move(*message));
  }
  exchange::LoopbackNetwork network;
  std::vector<std::vector<exchange::Message>> sent;
};

exchange::FrameEnd end_with(std::uint64_t fragments, std::uint64_t stopped = 0) {
  exchange::FrameEnd end{};
  end.counters.fragments = fragments;
  end.stopped = stopped;
  return end;
}

TEST(ImageAssembly, TilesFromAnyoneInAnyOrderMakeThePictureOnce) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    const int compositors = 1 + static_cast<int>(seed % 3);
    const bool deep = seed % 2 == 0;
    Job job(compositors);
    scene::Image expected(size);
    std::vector<bool> has_come(grid.count());
    std::vector<std::vector<float>> reds(expected.depth.size());  // of each pixel's deep samples
    std::map<std::size_t, MergedTile> tiles;
    {
      std::vector<std::unique_ptr<TileSender>> senders;
      for (int c = 0; c < compositors; ++c)
        senders.push_back(std::make_unique<TileSender>(job.network.rank(1 + c), 0, 9));
      std::vector<std::uint32_t> order(grid.count());
      for (std::uint32_t tile = 0; tile < order.size(); ++tile) order[tile] = tile;
      std::shuffle(order.begin(), order.end(), random);
      for (const std::uint32_t tile : order) {
        if (random() % 4 == 0) continue;  // nothing in it: it is not sent
        has_come[tile] = true;
        tiles.emplace(tile, random_tile(tile, deep, random));
        senders[random() % senders.size()]->send(tile, tiles.at(tile));
      }
      for (std::size_t c = 0; c < senders.size(); ++c) senders[c]->end(end_with(10 + c));
    }
    for (const auto& [number, tile] : tiles) {
      const scene::PixelRect rect = grid.rect(number);
      std::size_t p = 0, taken = 0;
      for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x, ++p) {
          const std::size_t at = expected.index(x, y);
          std::copy_n(&tile.image.rgba[4 * p], 4, &expected.rgba[4 * at]);
          expected.depth[at] = tile.image.depth[p];
          if (!deep) continue;
          for (std::uint32_t k = 0; k < tile.deep_counts[p]; ++k) reds[at].push_back(tile.deep_samples[taken++].red);
        }
    }
    job.collect();

    std::map<std::size_t, int> told;  // by the tile's first pixel
    ImageAssembly assembly(
        compositors, [](std::uint32_t) { return grid; }, deep ? 1 << 24 : 0,
        [&](std::uint32_t frame, const scene::PixelRect& rect, const scene::Image& image) {
          EXPECT_EQ(frame, 9u);
          ++told[expected.index(rect.x0, rect.y0)];
          for (int y = rect.y0; y < rect.y1; ++y)
            for (int x = rect.x0; x < rect.x1; ++x)
              EXPECT_EQ(image.depth[image.index(x, y)], expected.depth[expected.index(x, y)]);
        });
    std::optional<AssembledFrame> done;
    std::size_t left = 0;
    for (const auto& messages : job.sent) left += messages.size();
    std::vector<std::size_t> next(job.sent.size());
    while (left > 0) {
      const std::size_t c = random() % job.sent.size();
      if (next[c] == job.sent[c].size()) continue;
      EXPECT_FALSE(done.has_value()) << "before all had ended";
      done = assembly.accept(job.sent[c][next[c]++]);
      --left;
    }
    ASSERT_TRUE(done.has_value()) << "seed " << seed;
    EXPECT_EQ(done->frame, 9u);
    EXPECT_EQ(done->image.rgba, expected.rgba) << "seed " << seed;
    EXPECT_EQ(done->image.depth, expected.depth) << "seed " << seed;
    EXPECT_EQ(done->sums.counters.fragments,
              static_cast<std::uint64_t>(10 * compositors + compositors * (compositors - 1) / 2));
    EXPECT_EQ(told.size(), grid.count());
    for (const auto& [pixel, times] : told) EXPECT_EQ(times, 1) << pixel;
    if (!deep) continue;
    ASSERT_EQ(done->deep.begin.size(), reds.size() + 1);
    for (std::size_t p = 0; p < reds.size(); ++p) {
      std::vector<float> got;
      for (std::size_t k = done->deep.begin[p]; k < done->deep.begin[p + 1]; ++k)
        got.push_back(done->deep.samples[k].red);
      EXPECT_EQ(got, reds[p]) << "pixel " << p << ", seed " << seed;
    }
  }
}

TEST(ImageAssembly, FramesThatOverlapDoNotMix) {
  Job job(2);
  std::mt19937 random(1);
  const MergedTile tiles[2] = {random_tile(0, false, random), random_tile(0, false, random)};
  {
    TileSender early = job.sender(0, 5), late = job.sender(0, 6), other_early = job.sender(1, 5),
               other_late = job.sender(1, 6);
    late.send(0, tiles[1]);
    late.end({});
    other_late.end({});
    early.send(0, tiles[0]);
    other_early.end({});
    early.end({});
  }
  job.collect();
  ImageAssembly assembly(2, [](std::uint32_t) { return grid; });
  std::map<std::uint32_t, scene::Image> images;
  for (const auto& messages : job.sent)
    for (const exchange::Message& message : messages)
      if (auto done = assembly.accept(message)) images[done->frame] = std::move(done->image);
  ASSERT_EQ(images.size(), 2u);
  for (const std::uint32_t frame : {5u, 6u}) EXPECT_EQ(images[frame].depth[0], tiles[frame - 5].image.depth[0]);
}

TEST(ImageAssembly, AStoppedFrameTellsOnlyOfTilesThatCame) {
  Job job(1);
  std::mt19937 random(1);
  {
    TileSender sender = job.sender(0, 0);
    sender.send(1, random_tile(1, false, random));
    sender.end(end_with(0, 1));
  }
  job.collect();
  int told = 0;
  ImageAssembly assembly(
      1, [](std::uint32_t) { return grid; }, 0,
      [&](std::uint32_t, const scene::PixelRect&, const scene::Image&) { ++told; });
  std::optional<AssembledFrame> done;
  for (const exchange::Message& message : job.sent[0]) done = assembly.accept(message);
  ASSERT_TRUE(done.has_value());
  EXPECT_EQ(done->sums.stopped, 1u);
  EXPECT_EQ(told, 1);
}

TEST(ImageAssembly, WhatIsCutChangedOrNotTilesIsRefused) {
  Job job(1);
  std::mt19937 random(1);
  {
    TileSender sender = job.sender(0, 0);
    sender.send(2, random_tile(2, true, random));
    sender.end({});
  }
  job.collect();
  ASSERT_EQ(job.sent[0].size(), 2u);
  const auto refused = [&](const Bytes& bytes) {
    ImageAssembly assembly(
        1, [](std::uint32_t) { return grid; }, 1 << 24);
    try {
      assembly.accept({1, bytes});
      return false;
    } catch (const scene::Error& error) {
      EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
      return true;
    }
  };
  const auto frame_and = [](MessageKind kind, std::uint64_t tile) {
    Bytes message = exchange::message_of(kind, std::uint64_t{0});
    exchange::append(message, tile);
    return message;
  };
  constexpr std::size_t empty =
      sizeof(exchange::MessageHeader) + sizeof(std::uint64_t);  // of no tiles: that is allowed
  for (const exchange::Message& message : job.sent[0]) {
    ASSERT_FALSE(refused(message.bytes));
    for (std::size_t cut = 0; cut < message.bytes.size(); cut += cut < 200 ? 1 : 97) {
      const Bytes bytes(message.bytes.begin(), message.bytes.begin() + static_cast<std::ptrdiff_t>(cut));
      const bool tiles = exchange::MessageReader(message.bytes, 1).kind() == MessageKind::tiles;
      EXPECT_EQ(refused(bytes), !(tiles && cut == empty)) << cut << " of " << message.bytes.size();
    }
    Bytes longer = message.bytes;
    longer.push_back(std::byte{1});
    EXPECT_TRUE(refused(longer));
  }
  EXPECT_TRUE(refused(frame_and(MessageKind::tiles, grid.count())));
  EXPECT_TRUE(refused(frame_and(MessageKind::tiles, ~std::uint64_t{0})));
  EXPECT_TRUE(refused(frame_and(MessageKind::parts, 0)));

  // The number of deep samples, behind 32 x 13 pixels of tile 2: more than there are, however many.
  const scene::PixelRect rect = grid.rect(2);
  const std::size_t at = empty + sizeof(std::uint64_t) + static_cast<std::size_t>(rect.area()) * 5 * sizeof(float);
  for (const std::size_t byte : {0, 1, 4, 7}) {
    Bytes bytes = job.sent[0][0].bytes;
    bytes[at + byte] ^= std::byte{0x40};
    EXPECT_TRUE(refused(bytes)) << byte;
  }
  // One sample more in a pixel than there are in all.
  Bytes bytes = job.sent[0][0].bytes;
  bytes[at + sizeof(std::uint64_t)] ^= std::byte{8};
  EXPECT_TRUE(refused(bytes));
}

}  // namespace
}  // namespace tessera::compositor
