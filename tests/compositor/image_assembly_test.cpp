// SPDX-License-Identifier: BSD-3-Clause
// Transfer of tiles from compositors to the final image.
#include "compositor/image_assembly.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "exchange/loopback_transport.hpp"
#include "exchange/packed_pixels.hpp"
#include "scene/error.hpp"

namespace tessera::compositor::image_assembly_test {
namespace {

using exchange::Bytes;
using exchange::MessageKind;

constexpr scene::ImageSize size{70, 45};  // tiles at the edges are narrower
constexpr projection::TileGrid grid{size, 32};

AssemblySettings settings_of_grid(std::uint64_t deep_bytes = 0) {
  AssemblySettings settings;
  settings.grid_of = [](std::uint32_t) { return grid; };
  settings.deep_bytes = deep_bytes;
  return settings;
}

/// Runs each task on its own thread.
class ThreadEach {
 public:
  ThreadEach() = default;
  ~ThreadEach() {
    for (std::thread& thread : threads_) thread.join();
  }
  ThreadEach(const ThreadEach&) = delete;
  ThreadEach& operator=(const ThreadEach&) = delete;
  void run(std::function<void()> work) {
    threads_.emplace_back([work = std::move(work)] {
      try {
        work();
      } catch (const scene::Error&) {  // accept() throws it again
      }
    });
  }

 private:
  std::vector<std::thread> threads_;
};

/// A tile with random pixels, and perhaps deep samples.
MergedTile random_tile(std::size_t tile, bool deep, std::mt19937& random) {
  const scene::PixelRect rect = grid.rect(tile);
  MergedTile made;
  made.image = scene::Image({rect.x1 - rect.x0, rect.y1 - rect.y0});
  std::uniform_real_distribution<float> uniform(0, 1);
  const float step = random() % 2 == 0 ? 1 : 1e-4f;  // noise, or smooth enough that packing saves bytes
  for (auto* values : {&made.image.rgba, &made.image.depth})
    for (float& value : *values) value = 0.5f + step * uniform(random);
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
  /// The messages received, by compositor.
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

TEST(ImageAssembly, TilesFromAnyRankInAnyOrderMakeTheImageOnce) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    const int compositors = 1 + static_cast<int>(seed % 3);
    const bool deep = seed % 2 == 0;
    Job job(compositors);
    scene::Image expected(size);
    std::vector<bool> has_come(grid.count());
    std::vector<std::vector<float>> reds(expected.depth.size());  // red of each pixel's deep samples
    std::map<std::size_t, MergedTile> tiles;
    {
      std::vector<std::unique_ptr<TileSender>> senders;
      for (int c = 0; c < compositors; ++c)
        senders.push_back(std::make_unique<TileSender>(job.network.rank(1 + c), 0, 9));
      std::vector<std::uint32_t> order(grid.count());
      for (std::uint32_t tile = 0; tile < order.size(); ++tile) order[tile] = tile;
      std::shuffle(order.begin(), order.end(), random);
      for (const std::uint32_t tile : order) {
        if (random() % 4 == 0) continue;  // empty tiles are not sent
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

    std::map<std::size_t, int> reported;  // number of reports, by the tile's first pixel
    std::mutex telling;
    ThreadEach threads;
    AssemblySettings settings = settings_of_grid(deep ? 1 << 24 : 0);
    settings.finished = [&](std::uint32_t frame, const scene::PixelRect& rect, const scene::Image& image) {
      const std::lock_guard lock(telling);
      EXPECT_EQ(frame, 9u);
      ++reported[expected.index(rect.x0, rect.y0)];
      for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x)
          EXPECT_EQ(image.depth[image.index(x, y)], expected.depth[expected.index(x, y)]);
    };
    if (seed % 3 > 0) settings.run = [&](std::function<void()> work) { threads.run(std::move(work)); };
    if (seed % 5 > 0)
      settings.memory = [&](scene::ImageSize of) {  // for another image
        scene::Image memory(seed % 5 == 1 ? scene::ImageSize{of.height, of.width} : of);
        std::fill(memory.rgba.begin(), memory.rgba.end(), 7.0f);
        std::fill(memory.depth.begin(), memory.depth.end(), std::numeric_limits<float>::quiet_NaN());
        return memory;
      };
    ImageAssembly assembly(compositors, std::move(settings));
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
    EXPECT_EQ(reported.size(), grid.count());
    for (const auto& [pixel, times] : reported) EXPECT_EQ(times, 1) << pixel;
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
  ImageAssembly assembly(2, settings_of_grid());
  std::map<std::uint32_t, scene::Image> images;
  for (const auto& messages : job.sent)
    for (const exchange::Message& message : messages)
      if (auto done = assembly.accept(message)) images[done->frame] = std::move(done->image);
  ASSERT_EQ(images.size(), 2u);
  for (const std::uint32_t frame : {5u, 6u}) EXPECT_EQ(images[frame].depth[0], tiles[frame - 5].image.depth[0]);
}

TEST(ImageAssembly, AStoppedFrameReportsOnlyReceivedTiles) {
  Job job(1);
  std::mt19937 random(1);
  {
    TileSender sender = job.sender(0, 0);
    sender.send(1, random_tile(1, false, random));
    sender.end(end_with(0, 1));
  }
  job.collect();
  int reported = 0;
  AssemblySettings settings = settings_of_grid();
  settings.finished = [&](std::uint32_t, const scene::PixelRect&, const scene::Image&) { ++reported; };
  ImageAssembly assembly(1, std::move(settings));
  std::optional<AssembledFrame> done;
  for (const exchange::Message& message : job.sent[0]) done = assembly.accept(message);
  ASSERT_TRUE(done.has_value());
  EXPECT_EQ(done->sums.stopped, 1u);
  EXPECT_EQ(reported, 1);
}

/// Whether a message is refused, as Error(system_failure).
bool is_refused(const Bytes& bytes) {
  ImageAssembly assembly(1, settings_of_grid(1 << 24));
  try {
    assembly.accept({1, bytes});
    return false;
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
    return true;
  }
}

TEST(ImageAssembly, RefusesTruncatedChangedAndForeignMessages) {
  Job job(1);
  std::mt19937 random(1);
  {
    TileSender sender = job.sender(0, 0);
    sender.send(2, random_tile(2, true, random));
    sender.end({});
  }
  job.collect();
  ASSERT_EQ(job.sent[0].size(), 2u);
  const auto refused = is_refused;
  const auto frame_and = [](MessageKind kind, std::uint64_t tile) {
    Bytes message = exchange::message_of(kind, std::uint64_t{0});
    exchange::append(message, tile);
    return message;
  };
  constexpr std::size_t empty =
      sizeof(exchange::MessageHeader) + sizeof(std::uint64_t);  // a message without tiles is allowed
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

  // The number of deep samples follows the pixels of tile 2. The test replaces this number by larger ones.
  const scene::PixelRect rect = grid.rect(2);
  scene::Image image(size);
  exchange::MessageReader reader(job.sent[0][0].bytes, 1);
  reader.take_bytes(2 * sizeof(std::uint64_t));
  exchange::take_pixels(reader, image, rect);
  std::size_t left = 0;
  while (!reader.empty()) reader.take_bytes(1), ++left;
  const std::size_t at = job.sent[0][0].bytes.size() - left;
  for (const std::size_t byte : {0, 1, 4, 7}) {
    Bytes bytes = job.sent[0][0].bytes;
    bytes[at + byte] ^= std::byte{0x40};
    EXPECT_TRUE(refused(bytes)) << byte;
  }
  // A pixel states more samples than the message has in total.
  Bytes bytes = job.sent[0][0].bytes;
  bytes[at + sizeof(std::uint64_t)] ^= std::byte{8};
  EXPECT_TRUE(refused(bytes));
}

TEST(ImageAssembly, DamagedMessagesAreRefusedOrChangePixelsOnly) {
  Job job(1);
  std::mt19937 random(1);
  {
    TileSender sender = job.sender(0, 0);
    for (const std::uint32_t tile : {0u, 1u, 2u, 5u}) sender.send(tile, random_tile(tile, tile == 1, random));
    sender.end({});
  }
  job.collect();
  const Bytes& whole = job.sent[0][0].bytes;
  int refused = 0;
  for (int k = 0; k < 2000; ++k) {
    Bytes bytes = whole;
    for (unsigned changes = 1 + random() % 3; changes > 0; --changes)
      bytes[random() % bytes.size()] = static_cast<std::byte>(random());
    refused += is_refused(bytes) ? 1 : 0;
  }
  EXPECT_GT(refused, 20);
  EXPECT_LT(refused, 2000);
}

TEST(ImageAssembly, ATileThatComesTwiceIsRefused) {
  for (const bool threaded : {false, true}) {
    Job job(2);
    std::mt19937 random(1);
    for (const int compositor : {0, 1}) {
      TileSender sender = job.sender(compositor, 0);
      sender.send(3, random_tile(3, false, random));
      sender.end({});
    }
    job.collect();
    ThreadEach threads;
    AssemblySettings settings = settings_of_grid();
    if (threaded) settings.run = [&](std::function<void()> work) { threads.run(std::move(work)); };
    ImageAssembly assembly(2, std::move(settings));
    try {
      for (auto& messages : job.sent)
        for (exchange::Message& message : messages) EXPECT_FALSE(assembly.accept(std::move(message)).has_value());
      FAIL() << "it was taken";
    } catch (const scene::Error& error) {
      EXPECT_NE(std::string(error.what()).find("sends tile 3 again"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace tessera::compositor::image_assembly_test
