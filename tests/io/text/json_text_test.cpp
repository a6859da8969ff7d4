// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/json_text.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using test::expect_bad_input;

TEST(JsonText, IsReadAsTheLibraryReadsIt) {
  for (const std::string text :
       {"null", "-7", "18446744073709551615", "1.5e-300", R"("\u00e9 \n")", "[]", "{}", "[[], {}, [[1, [2]], 3], true]",
        R"({"b": {"c": [1, {"d": null}], "a": "x"}, "a": [false, -0.0]})"})
    EXPECT_EQ(parse_json(text, "f"), nlohmann::json::parse(text)) << text;
}

TEST(JsonText, IsRefusedWithItsPlace) {
  expect_bad_input([] { parse_json("", "f"); }, {"f: line 1, column 1: not valid JSON"});
  expect_bad_input([] { parse_json("{\"a\": 1,\n \"b\" 2}", "f"); }, {"f: line 2, column 6: not valid JSON"});
  expect_bad_input([] { parse_json("[1] 2", "f"); }, {"f: line 1, column 5: not valid JSON"});
  expect_bad_input([] { parse_json("[1e999]", "f"); }, {"f: not valid JSON", "number overflow"});
  expect_bad_input([] { parse_json(R"({"a": {"b": 1}, "c": 2, "a": 3})", "f"); }, {"'a' is given twice in one object"});
  EXPECT_NO_THROW(parse_json(R"({"a": {"a": 1}, "b": [{"a": 1}, {"a": 2}]})", "f"));
}

TEST(JsonText, HasALimitOfLevelsAndOfValues) {
  const auto nested = [](std::size_t levels) { return std::string(levels, '[') + std::string(levels, ']'); };
  EXPECT_NO_THROW(parse_json(nested(64), "f"));
  expect_bad_input([&] { parse_json(nested(65), "f"); }, {"more than 64 levels deep"});
  expect_bad_input([&] { parse_json(std::string(1'000'000, '['), "f"); }, {"more than 64 levels deep"});
  EXPECT_NO_THROW(parse_json(R"([1, {"a": []}])", "f", 4));
  expect_bad_input([] { parse_json(R"([1, {"a": []}])", "f", 3); }, {"f: it has more than 3 values"});
}

// Quadratic time would be hours.
TEST(JsonText, OfManyMembersIsReadInLinearTime) {
  std::string list = "[{}", object = "{\"0\":{}";
  constexpr std::size_t count = 1'000'000;
  for (std::size_t i = 1; i < count; ++i) {
    list += ",{}";
    object += ",\"" + std::to_string(i) + "\":{}";
  }
  EXPECT_EQ(parse_json(list + "]", "f").size(), count);
  EXPECT_EQ(parse_json(object + "}", "f").size(), count);
}

}  // namespace
}  // namespace tessera::io
