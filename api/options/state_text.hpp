// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/program/options.hpp"

/// Conversion between JSON values of options and words. Messages begin with `source` and call the option `name`.
namespace tessera::api {

/// None for null and false. Throws Error(bad_input) for a value of another type than the option takes.
std::vector<std::string> json_words(const OptionRow& row, const nlohmann::json& value, std::string_view name,
                                    const std::string& source);

/// Text, a list of texts or true, for words that are given.
nlohmann::json json_of_words(const OptionRow& row, const std::vector<std::string>& words);

}  // namespace tessera::api
