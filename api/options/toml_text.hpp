// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The subset of TOML in scene files: lines `key = value`, where a value is text, a number, true, false, or a list of
/// those, and comments. Tables, dates, nested lists and multi-line text are refused. Text that is a single word needs
/// no quotes.
namespace tessera::api {

struct TomlLine {
  std::string key;
  std::vector<std::string> values;  ///< without quotes; several for a list
};

/// Takes linear time; skips a UTF-8 byte order mark. Throws Error(bad_input, "SOURCE: line L: ...").
std::vector<TomlLine> parse_toml(std::string_view text, const std::string& source);

/// `value` in quotes, so that parse_toml() reads it back.
std::string toml_quoted(std::string_view value);

}  // namespace tessera::api
