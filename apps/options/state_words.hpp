// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

/// States of `tessera serve` as words of `tessera render`. States come from the network: only options of the table are
/// taken, none that reads or writes a file; but the surface files that the server was started with may be named again.
namespace tessera::apps {

/// Options by their long names, each with its values; "true" of a bare flag.
using OptionWords = std::vector<std::pair<std::string, std::vector<std::string>>>;

/// `base`, and over it what the state says; an option whose value is null or false is left out. Throws Error(bad_input)
/// in one sentence for a key that is no option of the table or a value of another kind.
OptionWords state_words(const OptionWords& base, const nlohmann::json& state);

/// Of `words` those that a state may have, as one.
nlohmann::json state_of_words(const OptionWords& words);

/// Null if there are none.
const std::vector<std::string>* find_words(const OptionWords& words, const std::string& option);

/// As arguments of render, each in one word: "--size=800x600".
std::vector<std::string> arguments_of(const OptionWords& words);

/// As a shell takes them, in single quotes where needed.
std::string shell_words(const std::vector<std::string>& arguments);

}  // namespace tessera::apps
