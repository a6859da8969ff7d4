// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tessera/program/options.hpp"

/// States of `tessera serve` as words of `tessera render`. States come from the network: only options that a state may
/// have are taken, none that reads or writes a file; but the surface files that the server was started with may be
/// named again.
namespace tessera {
inline namespace v0_1 {

/// `base`, and over it what the state gives; an option whose value is null or false is left out. Throws
/// Error(bad_input) in one sentence for a key that a state may not have, or a value of another kind.
OptionWords state_words(const OptionWords& base, const nlohmann::json& state);

/// Of `words` those that a state may have, as one.
nlohmann::json state_of_words(const OptionWords& words);

/// As arguments of render, each in one word: "--size=800x600".
std::vector<std::string> arguments_of(const OptionWords& words);

/// As a shell takes them, in single quotes where needed.
std::string shell_words(const std::vector<std::string>& arguments);

}  // namespace v0_1
}  // namespace tessera
