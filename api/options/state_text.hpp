// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/program/options.hpp"

/// Conversion between JSON values of options and words. Messages begin with `source` and use `name` for the option.
namespace tessera::api {

/// Converts a JSON value to words; null and false give no words. Throws Error(bad_input) if the value does not have the
/// option's type.
std::vector<std::string> json_words(const OptionRow& row, const nlohmann::json& value, std::string_view name,
                                    const std::string& source);

/// Converts one or more words to a text, a list of texts or true.
nlohmann::json json_of_words(const OptionRow& row, const std::vector<std::string>& words);

}  // namespace tessera::api
