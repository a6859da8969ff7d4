// SPDX-License-Identifier: BSD-3-Clause
#include "api/options/toml_text.hpp"

#include <gtest/gtest.h>

#include "tessera/error.hpp"

namespace tessera::api {
namespace {

using Values = std::vector<std::string>;

/// The values of the only line.
Values values_of(const std::string& text) {
  const std::vector<TomlLine> lines = parse_toml(text, "s.toml");
  EXPECT_EQ(lines.size(), 1U) << text;
  return lines.empty() ? Values{} : lines.front().values;
}

std::string refusal_of(const std::string& text) {
  try {
    parse_toml(text, "s.toml");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    return error.what();
  }
  ADD_FAILURE() << text << " is taken";
  return {};
}

TEST(TomlText, IsLinesOfKeysAndValues) {
  const std::vector<TomlLine> lines = parse_toml(
      "\xEF\xBB\xBF# a file\r\n  size = \"8x8\"   # small\n\niso=[ '0.5:red', # half\n  \"0.7\" ,\n]\nzoom = 2.5e-1",
      "s");
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].key, "size");
  EXPECT_EQ(lines[0].values, Values{"8x8"});
  EXPECT_EQ(lines[1].key, "iso");
  EXPECT_EQ(lines[1].values, (Values{"0.5:red", "0.7"}));
  EXPECT_EQ(lines[2].values, Values{"2.5e-1"});
  EXPECT_TRUE(parse_toml("", "s").empty());
  EXPECT_TRUE(parse_toml("# only this", "s").empty());
  EXPECT_EQ(values_of("a = []"), Values{});
}

TEST(TomlText, HasTextInQuotesOrOfOneWord) {
  EXPECT_EQ(values_of("a = left\r\n"), Values{"left"});
  EXPECT_EQ(values_of("a = true"), Values{"true"});
  EXPECT_EQ(values_of(R"(a = 'a "b" \n # [')"), Values{R"(a "b" \n # [)"});
  EXPECT_EQ(values_of(R"(a = "it's \"\\\t\u00e9\U0001F600")"), Values{"it's \"\\\t\xc3\xa9\xf0\x9f\x98\x80"});
  EXPECT_EQ(values_of("a = \"\""), Values{""});
}

TEST(TomlText, ComesBackFromItsQuotes) {
  for (const std::string text : {"", "plain", "\"'\\#[],=", "a\nb\r\t\x01\x7f", "\xc3\xa9 \xff"})
    EXPECT_EQ(values_of("a = " + toml_quoted(text)), Values{text}) << toml_quoted(text);
}

TEST(TomlText, IsRefusedWithItsLine) {
  for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
           {"a = 1\n[b]\n", "line 2: begins a table"},
           {"a = 1\nb\n", "line 2: 'b' has no value"},
           {"a.b = 1", "line 1: 'a.b' is not an option"},
           {" = 1", "line 1: '' is not an option"},
           {"a = 1\n\na = 2", "line 3: 'a' is given twice"},
           {"a = \"1", "line 1: text is not closed; end it with \""},
           {"a = '1\n'", "line 1: text is not closed; end it with '"},
           {"a = [\n1,\n2", "line 1: the list is not closed"},
           {"a = [[1]]", "line 1: has a list in a list"},
           {"a = [1 2]", "line 1: '2]' follows a value of a list"},
           {"a = 1 2", "line 1: '2' follows the value of 'a'"},
           {"a =\n", "line 1: a value is missing"},
           {R"(a = "\q")", "line 1: \\ begins no character"},
           {R"(a = "\u00")", "line 1: \\ begins no character"},
           {R"(a = "\ud800")", "line 1: \\ begins no character"},
           {"a = \"\"\"b\"\"\"", "line 1: text over several lines"},
           {std::string("a = \"\0\"", 7), "line 1: has a control character"},
           {"\xFF\xFEs", "is UTF-16"}})
    EXPECT_NE(refusal_of(text).find("s.toml: " + part), std::string::npos) << refusal_of(text);
}

}  // namespace
}  // namespace tessera::api
