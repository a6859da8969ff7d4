// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace tessera::apps {

/// The first entry of completions() if file names are possible too. The shell completes file names itself.
inline constexpr std::string_view file_completion = ":files";

/// Returns the possible completions of the last of `words`. These are the words between `tessera` and the cursor; the
/// last one may be empty. Completes commands, options, values of options, presets, and the fields and blocks of a file
/// named earlier, which is read for that purpose. Returns nothing if there are no completions. Does not throw.
std::vector<std::string> completions(const std::vector<std::string>& words);

/// Returns the script with which a shell (bash, zsh or fish) calls `tessera complete`. Throws Error(bad_input) for
/// another shell.
std::string completion_script(const std::string& shell);

}  // namespace tessera::apps
