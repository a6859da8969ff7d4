// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tessera/program/options.hpp"

/// Conversion between states of `tessera serve` and words of `tessera render`. States come from the network, so only
/// options that a state may have are accepted. Options that read or write a file are refused, except for surfaces from
/// the files with which the server was started.
namespace tessera {
inline namespace v0_1 {

/// Returns `base`, overridden by the state. An option whose value in the state is null or false is removed. Throws
/// Error(bad_input), with a message of one sentence, for a key that a state may not have and for a value of the wrong
/// type.
OptionWords state_words(const OptionWords& base, const nlohmann::json& state);

/// Returns a state with all of the `words` that a state may have.
nlohmann::json state_of_words(const OptionWords& words);

/// Returns the options as arguments of `render`, each as one word: "--size=800x600".
std::vector<std::string> arguments_of(const OptionWords& words);

/// Returns the arguments as text for a shell, in single quotes where needed.
std::string shell_words(const std::vector<std::string>& arguments);

}  // namespace v0_1
}  // namespace tessera
