// SPDX-License-Identifier: BSD-3-Clause
// Progress reports of a run.
#include "apps/render/progress.hpp"

#include <gtest/gtest.h>

namespace tessera::apps {
namespace {

TEST(StatusLine, OfReadingShowsKnownProgress) {
  const std::string stage = "reading a.vtu";
  EXPECT_EQ(reading_words(stage, std::nullopt, 1.2), "reading a.vtu, 1 s");
  EXPECT_EQ(reading_words(stage, ReadProgress{ReadProgress::Stage::reading, 0.454}, 3),
            "reading a.vtu: 45 %, 3 s, 4 s left");
  EXPECT_EQ(reading_words(stage, ReadProgress{ReadProgress::Stage::reading, 0}, 3), "reading a.vtu, 3 s");
  EXPECT_EQ(reading_words(stage, ReadProgress{ReadProgress::Stage::copying, 0.999}, 4),
            "reading a.vtu: 99 % of its points and cells copied, 4 s");
  EXPECT_EQ(reading_words(stage, ReadProgress{ReadProgress::Stage::copying, 1}, 12),
            "reading a.vtu: making tets of its cells, 12 s");
  EXPECT_EQ(reading_words("reading a.ply", ReadProgress{ReadProgress::Stage::filling, 0}, 9),
            "reading a.ply: filling it with tets, 9 s");
  EXPECT_EQ(reading_words("reading a.ply", ReadProgress{ReadProgress::Stage::filling, 0, 40}, 9),
            "reading a.ply: filling it with tets, 9 s of about 40");
  EXPECT_EQ(reading_words("reading a.ply", ReadProgress{ReadProgress::Stage::filling, 0, 40}, 41),
            "reading a.ply: filling it with tets, 41 s");
}

TEST(StatusLine, OfOtherStagesShowsTheRemainingTimeOnceItIsMeaningful) {
  EXPECT_EQ(stage_words("rendering 8192x8192", std::nullopt, 2), "rendering 8192x8192, 2 s");
  EXPECT_EQ(stage_words("rendering 8192x8192", 0.05, 2), "rendering 8192x8192: 5 %, 2 s");
  EXPECT_EQ(stage_words("rendering 8192x8192", 0.25, 4), "rendering 8192x8192: 25 %, 4 s, 12 s left");
  EXPECT_EQ(stage_words("rendering 8192x8192", 1, 4), "rendering 8192x8192: 100 %, 4 s");
}

TEST(StatusLine, IsEmptyUnlessItIsToBeShown) {
  StatusLine hidden(false);
  EXPECT_FALSE(hidden.shown());
  EXPECT_EQ(hidden.listener(), nullptr);
  // A task without work ends at once.
  StatusLine line(true);
  line.begin("reading a.vtu");
  const ReadProgressFunction listener = line.listener();
  ASSERT_NE(listener, nullptr);
  listener({ReadProgress::Stage::reading, 0.5});
}

}  // namespace
}  // namespace tessera::apps
