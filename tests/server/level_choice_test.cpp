// SPDX-License-Identifier: BSD-3-Clause
#include "server/level_choice.hpp"

#include <gtest/gtest.h>

namespace tessera::server {
namespace {

/// A client whose images take `fixed` milliseconds plus `full` at full size.
struct Cost {
  double fixed, full;
  [[nodiscard]] double at(std::size_t shrink) const { return fixed + full / (shrinks[shrink] * shrinks[shrink]); }
};

void move(LevelChoice& choice, const Cost& cost, int frames) {
  for (int i = 0; i < frames; ++i) choice.took(choice.shrink(), choice.wants_preview(), cost.at(choice.shrink()));
}

TEST(LevelChoice, FindsTheLargestPictureWithinTheBudget) {
  for (const Cost& cost : {Cost{1, 20}, Cost{5, 200}, Cost{20, 500}, Cost{2, 2000}}) {
    LevelChoice choice(100);
    move(choice, cost, 30);
    EXPECT_LE(cost.at(choice.shrink()), 100);
    EXPECT_FALSE(choice.wants_preview());
    if (choice.shrink() > 0) {
      EXPECT_GT(cost.at(choice.shrink() - 1), 85) << cost.full;
    }
  }
}

TEST(LevelChoice, ConvergesAndStays) {
  LevelChoice choice(100);
  const Cost cost{20, 500};
  move(choice, cost, 30);
  const std::size_t there = choice.shrink();
  for (int i = 0; i < 50; ++i) {
    move(choice, cost, 1);
    EXPECT_EQ(choice.shrink(), there);
  }
}

TEST(LevelChoice, RequestsAPreviewWhereTheDataTakeTooLong) {
  LevelChoice choice(100);
  const Cost slow{200, 300}, quick{5, 60};
  move(choice, slow, 10);
  ASSERT_TRUE(choice.wants_preview());
  move(choice, quick, 10);
  EXPECT_TRUE(choice.wants_preview());
  EXPECT_EQ(choice.shrink(), 0u);
  // When the camera is at rest, the full data may turn out to be fast enough.
  choice.full_took(slow.at(0));
  EXPECT_TRUE(choice.wants_preview());
  choice.full_took(80);
  EXPECT_FALSE(choice.wants_preview());
}

TEST(LevelChoice, BeginsByWhatTheFirstPictureTook) {
  LevelChoice quick(100), slow(100);
  quick.full_took(30);
  slow.full_took(220);
  EXPECT_EQ(quick.shrink(), 0u);
  EXPECT_GT(slow.shrink(), 1u);
}

TEST(LevelChoice, KeepsAtLeastAPixelASide) {
  EXPECT_EQ(shrunk({800, 600}, 2), (ImageSize{400, 300}));
  EXPECT_EQ(shrunk({1, 3}, 8), (ImageSize{1, 1}));
}

}  // namespace
}  // namespace tessera::server
