// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/picture_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "apps/render/spare_images.hpp"
#include "support/await.hpp"

namespace tessera::apps {
namespace {

TEST(PictureQueue, WritesAllInOrder) {
  for (const int writers : {0, 1}) {
    std::vector<int> written;
    PictureQueue queue(writers);
    for (int i = 0; i < 20; ++i) queue.add([&written, i] { written.push_back(i); });
    queue.finish();
    ASSERT_EQ(written.size(), 20u);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(written[static_cast<std::size_t>(i)], i);
  }
}

TEST(PictureQueue, SeveralWritersWriteAtOnceAndEachPictureOnce) {
  std::vector<std::atomic<int>> written(50);
  std::atomic<int> at_once = 0, most = 0;
  PictureQueue queue(3);
  for (auto& count : written)
    queue.add([&] {
      const int now = ++at_once;
      for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
      }
      EXPECT_TRUE(test::await([&] { return most > 1; }));
      ++count;
      --at_once;
    });
  queue.finish();
  for (const auto& count : written) EXPECT_EQ(count, 1);
  EXPECT_GT(most, 1);
  EXPECT_LE(most, 3);
}

TEST(PictureQueue, HoldsOneBeingWrittenAndOneThatWaits) {
  std::atomic<int> held = 0, most = 0;
  constexpr int left = 8;  ///< images from this one on are not followed by two others
  struct Picture {
    explicit Picture(std::atomic<int>& count) : held(count) { ++held; }
    ~Picture() { --held; }
    std::atomic<int>& held;
  };
  PictureQueue queue(1);
  for (int i = 0; i < 10; ++i) {
    const auto picture = std::make_shared<Picture>(held);
    // Each image is being written until two more images have been handed over.
    queue.add([picture, i, &held] { EXPECT_TRUE(test::await([&] { return held == 3 || i >= left; })); });
    most = std::max(most.load(), held.load());
  }
  queue.finish();
  EXPECT_LE(most, 3);  // the third image is the one being handed over
  EXPECT_EQ(held, 0);
}

TEST(PictureQueue, AnErrorEndsTheWritingAndReachesTheRenderer) {
  std::atomic<int> written = 0;
  PictureQueue queue(1);
  queue.add([] { throw std::runtime_error("full"); });
  EXPECT_THROW(
      {
        for (int i = 0; i < 5; ++i) queue.add([&written] { ++written; });
        queue.finish();
      },
      std::runtime_error);
  EXPECT_THROW(queue.finish(), std::runtime_error);
  EXPECT_EQ(written, 0);
}

TEST(PictureQueue, AnEarlyEndWritesQueuedImages) {
  std::atomic<int> written = 0;
  {
    std::atomic<bool> at_end = false;
    PictureQueue queue(1);
    for (int i = 0; i < 2; ++i)
      queue.add([&written, &at_end] {
        EXPECT_TRUE(test::await([&] { return at_end.load(); }));
        ++written;
      });
    EXPECT_EQ(written, 0);
    at_end = true;
  }
  EXPECT_EQ(written, 2);
}

TEST(SpareImages, GiveAnImageOfTheSizeOnceAndKeepFew) {
  SpareImages spare;
  EXPECT_TRUE(spare.take({4, 3}).rgba.empty());
  Image kept({4, 3});
  const float* const memory = kept.rgba.data();
  spare.keep(std::move(kept));
  EXPECT_EQ(spare.take({4, 3}).rgba.data(), memory);
  EXPECT_TRUE(spare.take({4, 3}).rgba.empty());
  spare.keep(Image({4, 3}));
  EXPECT_TRUE(spare.take({3, 4}).rgba.empty());
  EXPECT_TRUE(spare.take({4, 3}).rgba.empty()) << "what fits no later picture goes";
  for (int i = 0; i < 5; ++i) spare.keep(Image({4, 3}));
  int left = 0;
  while (!spare.take({4, 3}).rgba.empty()) ++left;
  EXPECT_EQ(left, 2);
}

}  // namespace
}  // namespace tessera::apps
