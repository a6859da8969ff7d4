// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tessera/program/options.hpp"

/// Conversion between states of `tessera serve` and words of `tessera render`. States come from the network: only
/// options that a state may have are accepted, and none that reads or writes a file, except that the surface files with
/// which the server was started may be named.
namespace tessera {
inline namespace v0_1 {

/// `base`, overridden by the state; an option whose value is null or false is removed. Throws Error(bad_input) in one
/// sentence for a key that a state may not have, or a value of the wrong type.
OptionWords state_words(const OptionWords& base, const nlohmann::json& state);

/// The state with those of the `words` that a state may have.
nlohmann::json state_of_words(const OptionWords& words);

/// As arguments of render, one word each: "--size=800x600".
std::vector<std::string> arguments_of(const OptionWords& words);

/// As shell input, in single quotes where needed.
std::string shell_words(const std::vector<std::string>& arguments);

}  // namespace v0_1
}  // namespace tessera
