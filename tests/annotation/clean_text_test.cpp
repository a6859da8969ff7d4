// SPDX-License-Identifier: BSD-3-Clause
// Any bytes become UTF-8 on one line, shortened to fit where necessary.

#include <gtest/gtest.h>

#include "annotation/typeface.hpp"

namespace tessera::annotation {
namespace {

TEST(CleanText, LeavesUtf8AsItIs) {
  for (const char* text :
       {"", "p [Pa]", "größe", "∇·u", "日本", "\xF0\x9F\x8C\x8A", "\xF4\x8F\xBF\xBF", "\xED\x9F\xBF"})
    EXPECT_EQ(clean_text(text), text);
}

TEST(CleanText, ShowsInvalidBytesAndBlanksControls) {
  const std::string mark = "\xEF\xBF\xBD";
  EXPECT_EQ(clean_text("a\xFF"
                       "b"),
            "a" + mark + "b");
  EXPECT_EQ(clean_text("\xC3"), mark);                                   // truncated
  EXPECT_EQ(clean_text("\xE2\x82"), mark + mark);                        // truncated
  EXPECT_EQ(clean_text("\xC0\x80"), mark + mark);                        // overlong
  EXPECT_EQ(clean_text("\xE0\x80\x80"), mark + mark + mark);             // overlong
  EXPECT_EQ(clean_text("\xED\xA0\x80"), mark + mark + mark);             // surrogate
  EXPECT_EQ(clean_text("\xF4\x90\x80\x80"), mark + mark + mark + mark);  // above U+10FFFF
  EXPECT_EQ(clean_text("a\tb\nc\x7F"), "a b c ");
  EXPECT_EQ(clean_text(std::string("a\0b", 3)), "a b");
}

TEST(Typeface, TextThatIsTooLongLosesItsMiddle) {
  const Typeface face(12);
  const std::string name = "a_very_long_name_of_a_field_that_nobody_reads [m/s]";
  EXPECT_EQ(face.fitted(name, 1e6), name);
  std::size_t before = name.size() + 3;  // "…" has three bytes
  for (double room = face.width(name) - 1; room > 20; room *= 0.8) {
    const std::string fitted = face.fitted(name, room);
    ASSERT_FALSE(fitted.empty());
    EXPECT_LE(face.width(fitted), room);
    EXPECT_NE(fitted.find("…"), std::string::npos);
    EXPECT_EQ(fitted.front(), 'a');
    EXPECT_LT(fitted.size(), before);
    before = fitted.size() + 1;
  }
  EXPECT_NE(face.fitted(name, face.width(name) - 20).find("[m/s]"), std::string::npos);
  EXPECT_EQ(face.fitted(name, 1), "");
  EXPECT_EQ(face.fitted("", 1), "");
}

TEST(Typeface, LettersOfSeveralBytesAreNotCut) {
  const Typeface face(12);
  std::string text;
  for (int i = 0; i < 100; ++i) text += "Ω日é\xF0\x9F\x8C\x8A";
  for (double room = 10; room < 300; room += 7) {
    const std::string fitted = face.fitted(text, room);
    EXPECT_EQ(clean_text(fitted), fitted);
    EXPECT_LE(face.width(fitted), room);
  }
}

TEST(Typeface, HugeTextsTakeNoTime) {
  const Typeface face(12);
  const std::string fitted = face.fitted(std::string(20'000'000, 'i'), 300);
  EXPECT_LE(face.width(fitted), 300);
  EXPECT_GT(face.width(fitted), 280);
}

TEST(Typeface, LengthsGoWithItsSize) {
  const Typeface small(10), large(20);
  EXPECT_NEAR(large.width("Tessera 0.5"), 2 * small.width("Tessera 0.5"), 1e-6);
  EXPECT_GT(small.ascent(), small.descent());
  EXPECT_LT(small.line(), 15);
}

}  // namespace
}  // namespace tessera::annotation
