// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/program/options.hpp"

/// JSON values of options to words and back. `name` is what `source`, which messages begin with, calls the option.
namespace tessera::api {

/// Of null and false none. Throws Error(bad_input) for another kind of value than the option takes.
std::vector<std::string> json_words(const OptionRow& row, const nlohmann::json& value, std::string_view name,
                                    const std::string& source);

/// Text, a list of texts or true, of words that are given.
nlohmann::json json_of_words(const OptionRow& row, const std::vector<std::string>& words);

}  // namespace tessera::api
