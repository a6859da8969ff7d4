#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace tessera::io {

/// Parses JSON, or throws Error(bad_input, "SOURCE: line L, column C: not valid JSON ..."). Refuses what would be read
/// otherwise than meant or could not be held: a key twice in one object, numbers beyond double's range, more than 64
/// levels of nesting.
nlohmann::json parse_json(std::string_view text, const std::string& source);

}  // namespace tessera::io
