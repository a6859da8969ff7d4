// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace tessera::apps {

/// The first line of completions() where names of files may stand too: shells know them best.
inline constexpr std::string_view file_completion = ":files";

/// What the last of `words` may become: those after `tessera` up to the cursor, the last perhaps empty. Commands,
/// options, the words that an option takes, presets, and fields and blocks of the file that is named before, which is
/// read for them. Nothing for what cannot be known; throws nothing.
std::vector<std::string> completions(const std::vector<std::string>& words);

/// The script by which a shell asks `tessera complete`: bash, zsh or fish. Throws Error(bad_input) for another.
std::string completion_script(const std::string& shell);

}  // namespace tessera::apps
