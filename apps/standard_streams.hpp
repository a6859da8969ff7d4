// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace tessera::apps {

/// Reads standard input to its end into a nameless file in the folder of temporary files, and gives a name by which
/// readers and helper programs open it while this process lives. Throws Error(bad_input) if it is a terminal or empty,
/// Error(system_failure) if the disk is full.
std::filesystem::path spool_standard_input();

/// `text` with that name as "standard input", for whatever is printed or reported.
std::string with_stream_names(std::string text);

/// Throws Error(bad_input) naming the option if standard output is a terminal.
void require_no_terminal(const char* option);

/// To standard output, at once. Throws Error(system_failure) if it does not take all.
void write_standard_output(std::string_view bytes);

}  // namespace tessera::apps
