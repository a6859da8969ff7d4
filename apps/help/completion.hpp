// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace tessera::apps {

/// The first line of completions() if file names are also possible: the shell completes these itself.
inline constexpr std::string_view file_completion = ":files";

/// Possible completions of the last of `words`, which are the words between `tessera` and the cursor; the last may be
/// empty. Completes commands, options, option values, presets, and the fields and blocks of a file named earlier, which
/// is read for that purpose. Empty if nothing is known; does not throw.
std::vector<std::string> completions(const std::vector<std::string>& words);

/// The script with which a shell (bash, zsh or fish) calls `tessera complete`. Throws Error(bad_input) for another
/// shell.
std::string completion_script(const std::string& shell);

}  // namespace tessera::apps
