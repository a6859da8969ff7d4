// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "apps/command_line.hpp"

/// A run of `render` as a TOML file: options by their long names, `input` and `more` for its positional arguments, in
/// the words of the command line; of several values an array. File names are relative to where the program is called.
namespace tessera::apps {

/// `arguments`, those after `tessera`, with what the file of their --config gives and they do not. Throws
/// Error(bad_input) naming the file and what in it is no option.
std::vector<std::string> with_scene_file(const std::vector<std::string>& arguments);

/// Declares --config and --save-config.
void add_scene_options(CLI::App& render, RenderWords& words);

/// What was given as the text of such a file, but for --config and --save-config.
std::string scene_text(const CLI::App& render);

}  // namespace tessera::apps
