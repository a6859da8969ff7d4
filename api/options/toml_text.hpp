// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The TOML of scene files: lines `key = value`, where a value is text, a number, true, false, or a list of those, and
/// comments. Tables, dates, lists in lists and text over several lines are refused. Text without quotes is taken too,
/// where it is one word.
namespace tessera::api {

struct TomlLine {
  std::string key;
  std::vector<std::string> values;  ///< without their quotes; several of a list
};

/// In linear time; passes over a UTF-8 byte order mark. Throws Error(bad_input, "SOURCE: line L: ...").
std::vector<TomlLine> parse_toml(std::string_view text, const std::string& source);

/// `value` in quotes, as parse_toml() takes it back.
std::string toml_quoted(std::string_view value);

}  // namespace tessera::api
