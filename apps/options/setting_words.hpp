// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Libraries know settings, the program has options: where a message says "raise `memory`", its user reads
/// "raise --memory". Whatever a library has worded goes through here before it is printed or reported.
namespace tessera::apps {

/// The names of all options, as settings: words with _ between them, in alphabetical order.
std::span<const std::string_view> option_settings();

/// `text` with every setting as its option: `deep_accuracy`, in backquotes, becomes --deep-accuracy. Only names that
/// are options, and only where they stand as words of their own: file names may hold backquotes. (One that is all of
/// `memory`, backquotes and no folder, is taken for the setting.)
std::string with_options(std::string_view text);
std::vector<std::string> with_options(const std::vector<std::string>& notes);

}  // namespace tessera::apps
