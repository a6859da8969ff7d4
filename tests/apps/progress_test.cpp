// What a run says while a file is read.
#include "apps/progress.hpp"

#include <gtest/gtest.h>

namespace tessera::apps {
namespace {

TEST(ReadingLine, SaysHowFarItIsAsFarAsThatIsKnown) {
  EXPECT_EQ(reading_words("a.vtu", std::nullopt, 1.2), "reading a.vtu, 1 s");
  EXPECT_EQ(reading_words("a.vtu", ReadProgress{ReadProgress::Stage::reading, 0.454}, 3), "reading a.vtu: 45 %, 3 s");
  EXPECT_EQ(reading_words("a.vtu", ReadProgress{ReadProgress::Stage::reading, 0}, 3), "reading a.vtu, 3 s");
  EXPECT_EQ(reading_words("a.vtu", ReadProgress{ReadProgress::Stage::copying, 0.999}, 4),
            "reading a.vtu: 99 % of its points and cells copied, 4 s");
  EXPECT_EQ(reading_words("a.vtu", ReadProgress{ReadProgress::Stage::copying, 1}, 12),
            "reading a.vtu: making tets of its cells, 12 s");
}

TEST(ReadingLine, IsNotThereUnlessItIsToBeShown) {
  ReadingLine hidden(false, "a.vtu");
  EXPECT_EQ(hidden.listener(), nullptr);
  // One that comes to nothing ends at once.
  ReadingLine line(true, "a.vtu");
  const ReadProgressFunction listener = line.listener();
  ASSERT_NE(listener, nullptr);
  listener({ReadProgress::Stage::reading, 0.5});
}

}  // namespace
}  // namespace tessera::apps
