// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "scene/error.hpp"

namespace tessera::io {

/// Largest number of values in a JSON text, far more than useful files contain. The limit is needed because a file of a
/// few MiB could take a few GiB of memory.
constexpr std::size_t most_json_values = 20'000'000;

/// Parses JSON in linear time, or throws Error(bad_input, "SOURCE: line L, column C: not valid JSON ..."). Refuses
/// texts that would be misread or exceed a limit: a duplicate key in an object, numbers beyond double's range, more
/// than 64 levels of nesting, more than `most_values` values (objects and lists count too).
nlohmann::json parse_json(std::string_view text, const std::string& source, std::size_t most_values = most_json_values);

/// Implements tessera::is_json_text().
inline bool is_json_text(std::string_view file_or_json) {
  return file_or_json.starts_with('{') || file_or_json.starts_with('[');
}

/// Returns the error of parse_json() for a stream parser: `byte` is the position in the text, counted from 1, and
/// `message` is the parser's message.
scene::Error not_json(std::string_view text, const std::string& source, std::size_t byte, const std::string& message);

}  // namespace tessera::io
