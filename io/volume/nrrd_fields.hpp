// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace tessera::io {

/// The fields and key/value pairs of an NRRD header.
struct NrrdFields {
  std::map<std::string, std::string> values;  ///< the key is the field's name without blanks: "spaceorigin"
  std::map<std::string, std::string> keys;    ///< pairs `KEY:=VALUE`, whose meaning the format does not define
  std::size_t end = 0;                        ///< position of a payload that is in the same file

  [[nodiscard]] const std::string* find(const char* name) const {
    const auto v = values.find(name);
    return v == values.end() ? nullptr : &v->second;
  }
};

/// Parses a header's text, including its first line. Throws Error(bad_input).
NrrdFields nrrd_fields_of(std::string_view text, const std::filesystem::path& file);

}  // namespace tessera::io
