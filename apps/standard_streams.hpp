// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace tessera::apps {

/// Reads standard input to its end into a nameless file in the directory for temporary files, and returns a name with
/// which readers and helper programs open it during this process. Throws Error(bad_input) if it is a terminal or empty,
/// Error(system_failure) if the disk is full.
std::filesystem::path spool_standard_input();

/// `text` with that name replaced by "standard input", for all that is printed or reported.
std::string with_stream_names(std::string text);

/// Throws Error(bad_input) naming the option if standard output is a terminal.
void require_no_terminal(const char* option);

/// Writes to standard output at once. Throws Error(system_failure) if not all bytes are written.
void write_standard_output(std::string_view bytes);

}  // namespace tessera::apps
