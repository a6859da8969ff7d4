// SPDX-License-Identifier: BSD-3-Clause
// Placeholders in braces.

#include <gtest/gtest.h>

#include <array>

#include "tessera/annotation.hpp"
#include "tessera/error.hpp"

namespace tessera {
namespace {

const std::array<AnnotationWord, 3> facts{{{"field", "p"}, {"time", "0.5"}, {"file", "{field}"}}};

TEST(FillIn, ReplacesWordsByValues) {
  EXPECT_EQ(fill_in("{field} at {time} s", facts), "p at 0.5 s");
  EXPECT_EQ(fill_in("{field}{field}", facts), "pp");
  EXPECT_EQ(fill_in("", facts), "");
}

TEST(FillIn, DoesNotLookIntoValues) { EXPECT_EQ(fill_in("{file}", facts), "{field}"); }

TEST(FillIn, LeavesOtherBracesAlone) {
  for (const char* text : {"{", "}", "{}", "a {2} b", "{Field}", "x^{n+1}", "{time", "time}", "{a b}"})
    EXPECT_EQ(fill_in(text, facts), text);
}

TEST(FillIn, ListsTheKnownWordsForAnUnknownOne) {
  try {
    (void)fill_in("{tiem}", facts);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "`annotate`: {tiem} is unknown; use {field} {time} {file}");
  }
}

}  // namespace
}  // namespace tessera
