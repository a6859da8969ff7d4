// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace tessera::apps {

/// Reads standard input to its end into a nameless file in the directory for temporary files. Returns a name with which
/// readers and helper programs can open the file during this process. Throws Error(bad_input) if standard input is a
/// terminal or empty, and Error(system_failure) if the disk is full.
std::filesystem::path spool_standard_input();

/// Returns `text` with the name of that file replaced by "standard input". For all text that is printed or reported.
std::string with_stream_names(std::string text);

/// Throws Error(bad_input), which names the option, if standard output is a terminal.
void require_no_terminal(const char* option);

/// Writes to standard output at once. Throws Error(system_failure) if not all bytes are written.
void write_standard_output(std::string_view bytes);

}  // namespace tessera::apps
