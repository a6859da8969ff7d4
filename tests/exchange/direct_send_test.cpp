// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/direct/direct_send.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "exchange/loopback_transport.hpp"
#include "exchange/message.hpp"
#include "scene/error.hpp"

namespace tessera::exchange {
namespace {

constexpr scene::ImageSize size{70, 301};  ///< bands of up to four ranks have several packets

TEST(DirectSend, OrdersAreThoseOfAlgorithm1Corrected) {
  const std::vector<int> order{4, 2, 0, 5, 1, 3};
  EXPECT_EQ(send_order(order, 2), (std::vector<int>{5, 1, 3, 2, 4}));
  EXPECT_EQ(send_order(order, 0), (std::vector<int>{2, 0, 5, 1, 3}));
  EXPECT_EQ(send_order(order, 5), (std::vector<int>{1, 5, 0, 2, 4}));
  const std::vector<Layer> layers = receive_order(order, 2);
  const std::vector<Layer> expected{{2, true}, {4, true}, {5, false}, {1, false}, {3, false}};
  ASSERT_EQ(layers.size(), expected.size());
  for (std::size_t n = 0; n < layers.size(); ++n) {
    EXPECT_EQ(layers[n].rank, expected[n].rank);
    EXPECT_EQ(layers[n].in_front, expected[n].in_front);
  }
}

TEST(DirectSend, BandsMakeUpTheArea) {
  for (const int ranks : {1, 2, 3, 7, 12}) {
    for (const PixelRect area : {PixelRect{3, 5, 40, 55}, PixelRect{0, 7, 9, 10}, PixelRect{0, 0, 0, 0}}) {
      int row = area.y0;
      for (int rank = 0; rank < ranks; ++rank) {
        const PixelRect band = band_of(area, rank, ranks);
        EXPECT_EQ(band.y0, row);
        EXPECT_EQ(band.x0, area.x0);
        row = band.y1;
      }
      EXPECT_EQ(row, area.y1);
    }
  }
}

/// A rank's contribution: pixels of a rectangle, some of them empty.
struct Seen {
  PixelRect rect;
  scene::Image image{size};
  std::vector<float> bounds = std::vector<float>(image.depth.size());
};

Seen random_picture(const PixelRect& area, std::mt19937& random, bool whole) {
  std::uniform_real_distribution<float> uniform(0, 1);
  const auto between = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  Seen seen;
  const int x0 = between(area.x0, area.x1), y0 = between(area.y0, area.y1);
  seen.rect = whole ? area : PixelRect{x0, y0, between(x0, area.x1), between(y0, area.y1)};
  for (int y = seen.rect.y0; y < seen.rect.y1; ++y)
    for (int x = seen.rect.x0; x < seen.rect.x1; ++x) {
      if (uniform(random) < 0.3f) continue;
      const std::size_t pixel = seen.image.index(x, y);
      const float alpha = uniform(random) < 0.1f ? 1.0f : uniform(random);
      for (std::size_t c = 0; c < 3; ++c) seen.image.rgba[4 * pixel + c] = alpha * uniform(random);
      seen.image.rgba[4 * pixel + 3] = alpha;
      seen.image.depth[pixel] = 1 + uniform(random);
      seen.bounds[pixel] = 1e-6f * uniform(random);
    }
  return seen;
}

struct Truth {
  std::array<double, 4> rgba{};
  float depth = HUGE_VALF;
  double bound = 0;
};

Truth composited(const std::vector<Seen>& seen, const std::vector<int>& order, std::size_t pixel) {
  Truth truth;
  for (const int rank : order) {
    const Seen& of = seen[static_cast<std::size_t>(rank)];
    const double through = 1 - truth.rgba[3];
    for (std::size_t c = 0; c < 4; ++c) truth.rgba[c] += through * static_cast<double>(of.image.rgba[4 * pixel + c]);
    if (std::isinf(truth.depth)) truth.depth = of.image.depth[pixel];
    truth.bound += static_cast<double>(of.bounds[pixel]);
  }
  return truth;
}

TEST(DirectSend, BandsMatchTheDepthOrderedComposite) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 24; ++trial) {
    const int ranks = 1 + trial % 12;
    const PixelRect area = trial % 5 == 4 ? PixelRect{3, 2, 50, 6} : PixelRect{2, 1, 69, 300};
    std::vector<int> order(static_cast<std::size_t>(ranks));
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    std::vector<Seen> seen;
    seen.reserve(static_cast<std::size_t>(ranks));
    for (int rank = 0; rank < ranks; ++rank) seen.push_back(random_picture(area, random, trial % 3 == 0));
    const bool with_bounds = trial % 2 == 0;
    std::vector<PixelRect> own;
    own.reserve(seen.size());
    for (const Seen& of : seen) own.push_back(of.rect);
    const std::vector<int> bands = band_numbers(own);

    std::vector<scene::Image> by_way[2];
    for (const tessera::DirectSend how : {tessera::DirectSend::asynchronous, tessera::DirectSend::synchronous}) {
      std::vector<scene::Image>& images = by_way[static_cast<std::size_t>(how)];
      images.resize(static_cast<std::size_t>(ranks));
      std::vector<std::vector<float>> bounds(static_cast<std::size_t>(ranks));
      run_ranks(ranks, [&](Transport& transport) {
        const auto rank = static_cast<std::size_t>(transport.rank());
        DirectSendTask task{order, bands, area, seen[rank].rect, 5};
        images[rank] = seen[rank].image;
        if (with_bounds) bounds[rank] = seen[rank].bounds;
        const DirectSendResult result = DirectSender(transport).run(how, task, images[rank], bounds[rank]);
        EXPECT_FALSE(result.stopped);
        EXPECT_EQ(result.messages > 0, ranks > 1);
      });
      for (int rank = 0; rank < ranks; ++rank) {
        const PixelRect band = band_of(area, bands[static_cast<std::size_t>(rank)], ranks);
        const scene::Image& image = images[static_cast<std::size_t>(rank)];
        for (int y = band.y0; y < band.y1; ++y)
          for (int x = band.x0; x < band.x1; ++x) {
            const std::size_t pixel = image.index(x, y);
            const Truth truth = composited(seen, order, pixel);
            // Eleven roundings of numbers up to 1.
            for (std::size_t c = 0; c < 4; ++c) ASSERT_NEAR(image.rgba[4 * pixel + c], truth.rgba[c], 1e-6);
            ASSERT_EQ(image.depth[pixel], truth.depth) << x << ' ' << y;
            if (with_bounds) {
              ASSERT_NEAR(bounds[static_cast<std::size_t>(rank)][pixel], truth.bound, 1e-10);
            }
          }
      }
    }
    for (int rank = 0; rank < ranks; ++rank) {
      const auto r = static_cast<std::size_t>(rank);
      EXPECT_EQ(by_way[0][r].rgba, by_way[1][r].rgba);
    }
  }
}

TEST(DirectSend, BandsAreNearWhereRanksHavePixels) {
  EXPECT_EQ(band_numbers({}), std::vector<int>());
  const std::vector<PixelRect> own{{0, 200, 9, 300}, {0, 0, 9, 100}, {0, 0, 9, 290}, {0, 0, 9, 100}};
  EXPECT_EQ(band_numbers(own), (std::vector<int>{3, 0, 2, 1}));
}

TEST(DirectSend, AStoppedRankIsMissingInAllBands) {
  for (const tessera::DirectSend how : {tessera::DirectSend::asynchronous, tessera::DirectSend::synchronous})
    run_ranks(3, [&](Transport& transport) {
      const std::vector<int> order{2, 0, 1}, bands{0, 1, 2};
      const PixelRect area{0, 0, size.width, size.height};
      DirectSendTask task{order, bands, area, area, 0};
      task.stopped = transport.rank() == 1;
      scene::Image image(size);
      EXPECT_TRUE(DirectSender(transport).run(how, task, image, {}).stopped);
    });
}

TEST(DirectSend, MessagesOfAnotherImageEndTheRun) {
  const PixelRect area{0, 0, size.width, size.height};
  const std::vector<int> order{0, 1};
  struct Header {
    std::uint64_t frame;
    PixelRect rows, rect;
    std::uint64_t stopped;
  };
  const PixelRect rows{0, 0, size.width, packet_rows};
  const Header wrong[] = {{6, rows, rows, 0},
                          {7, {0, 1, size.width, packet_rows}, rows, 0},
                          {7, rows, {0, 0, size.width + 1, packet_rows}, 0},
                          {7, rows, {0, -1, size.width, packet_rows}, 0},
                          {7, rows, {9, 0, 3, packet_rows}, 0},
                          {7, rows, rows, 0},           // pixels are missing
                          {7, rows, {0, 0, 0, 0}, 1}};  // a stop message with one byte too many
  for (const Header& header : wrong) {
    EXPECT_THROW(run_ranks(2,
                           [&](Transport& transport) {
                             if (transport.rank() == 1) {
                               Bytes bytes = message_of(MessageKind::packet, header);
                               if (header.stopped != 0) append(bytes, std::uint8_t{0});
                               transport.send(0, Channel::fragments, std::move(bytes));
                               return;
                             }
                             scene::Image image(size);
                             const DirectSendTask task{order, order, area, area, 7};
                             DirectSender(transport).run(tessera::DirectSend::asynchronous, task, image, {});
                           }),
                 scene::Error);
  }
}

}  // namespace
}  // namespace tessera::exchange
