// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The subset of TOML in scene files: comments and lines `key = value`, where the value is text, a number, true, false,
/// or a list of these. Tables, dates, nested lists and multi-line text cause an error. A text of a single word does not
/// need quotes.
namespace tessera::api {

struct TomlLine {
  std::string key;
  std::vector<std::string> values;  ///< values without quotes; several for a list
};

/// Parses in linear time and skips a UTF-8 byte order mark. Throws Error(bad_input), whose message begins with `source`
/// and the line.
std::vector<TomlLine> parse_toml(std::string_view text, const std::string& source);

/// Returns `value` in quotes, in the form that parse_toml() reads.
std::string toml_quoted(std::string_view value);

}  // namespace tessera::api
