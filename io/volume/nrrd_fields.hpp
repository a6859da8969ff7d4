// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace tessera::io {

/// The fields and key/value pairs of an NRRD header.
struct NrrdFields {
  std::map<std::string, std::string> values;  ///< by name without blanks: "space origin" and "spaceorigin" are one
  std::map<std::string, std::string> keys;    ///< pairs `KEY:=VALUE`, which the format gives no meaning
  std::size_t end = 0;                        ///< where an attached payload begins

  [[nodiscard]] const std::string* find(const char* name) const {
    const auto v = values.find(name);
    return v == values.end() ? nullptr : &v->second;
  }
};

/// Of a header's text, its first line included. Throws Error(bad_input).
NrrdFields nrrd_fields_of(std::string_view text, const std::filesystem::path& file);

}  // namespace tessera::io
