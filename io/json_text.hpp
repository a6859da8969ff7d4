#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "scene/error.hpp"

namespace tessera::io {

/// Parses JSON, or throws Error(bad_input, "SOURCE: line L, column C: not valid JSON ..."). Refuses what would be read
/// otherwise than meant or could not be held: a key twice in one object, numbers beyond double's range, more than 64
/// levels of nesting.
nlohmann::json parse_json(std::string_view text, const std::string& source);

/// tessera::is_json_text().
inline bool is_json_text(std::string_view file_or_json) {
  return file_or_json.starts_with('{') || file_or_json.starts_with('[');
}

/// That error, for who parses as a stream: `byte` of the text, counted from 1, and the parser's own words.
scene::Error not_json(std::string_view text, const std::string& source, std::size_t byte, const std::string& message);

}  // namespace tessera::io
