// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/program/printable.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tessera {
namespace {

TEST(Printable, KeepsVisibleCharacters) {
  for (const std::string text : {"", "plain",
                                 "Dr\xc3\xbc"
                                 "cke",
                                 "\xc2\xa0", "\xe2\x82\xac", "\xf0\x9f\x98\x80", "caf\xe9", "\xe5\xb1\xb1"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, ReplacesTerminalControlsByBlanks) {
  EXPECT_EQ(printable("\x1b[2Jf"), " [2Jf");
  EXPECT_EQ(printable("a\nb\r\tc\x7f"), "a b  c ");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a b");
  EXPECT_EQ(printable("a\xc2\x9b"
                      "31m"),
            "a 31m")
      << "U+009B";
  EXPECT_EQ(printable("\xc2\x80\xc2\x9f\xc2\xa1"), "  \xc2\xa1");
  EXPECT_EQ(printable("a\x9b"
                      "31m"),
            "a 31m")
      << "the byte alone, as terminals without UTF-8 take it";
  EXPECT_EQ(printable("\xe2\x82"), "\xe2 ") << "a character cut short";
}

TEST(Printable, ReplacesBidirectionalControlsByBlanks) {
  for (const std::string mark : {"\xd8\x9c", "\xe2\x80\x8e", "\xe2\x80\x8f", "\xe2\x80\xaa", "\xe2\x80\xae",
                                 "\xe2\x81\xa6", "\xe2\x81\xa9", "\xe2\x80\xa8"})
    EXPECT_EQ(printable("a" + mark + "b"), "a b");
  EXPECT_EQ(printable("\xe2\x80\x93\xe2\x80\xaf\xe2\x81\xa5\xe2\x81\xaa"),
            "\xe2\x80\x93\xe2\x80\xaf\xe2\x81\xa5\xe2\x81\xaa")
      << "their neighbours";
}

TEST(Printable, OmitsTheMiddleOfLongText) {
  EXPECT_EQ(printable(std::string(4000, 'y')), std::string(4000, 'y'));
  const std::string shown = printable("begin" + std::string(30'000'000, 'y') + "end; remedy");
  EXPECT_LT(shown.size(), 4100u);
  EXPECT_TRUE(shown.starts_with("beginyyy"));
  EXPECT_TRUE(shown.ends_with("yyyend; remedy"));
  EXPECT_NE(shown.find("y ... y"), std::string::npos);
  std::string wide;
  for (int k = 0; k < 3001; ++k) wide += "\xe2\x82\xac";
  const std::string cut = printable(wide + "x");
  EXPECT_EQ(cut.find("\xe2\x82\xac ... \xe2\x82\xac"), cut.find(" ... ") - 3) << "whole characters on both sides";
}

}  // namespace
}  // namespace tessera
