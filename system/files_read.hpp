// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tessera::system {

/// Remembers that this process, or a reader program for it, has opened a regular file to read: no output is to replace
/// it (tessera/program/output_file.hpp), and all ranks are to have the same (api/same_files.hpp). From any thread.
void note_read(const std::filesystem::path& file);

/// Only protects it from outputs: for a file that an input names and this run may not open.
void note_named(const std::filesystem::path& file);

/// Whether the file of this device and number has been read.
bool was_read(std::uint64_t device, std::uint64_t number);

/// Names under which files have been read since this was last asked, in order of the alphabet, each once.
std::vector<std::string> take_names_read();

}  // namespace tessera::system
