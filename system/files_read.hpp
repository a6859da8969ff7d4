// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tessera::system {

/// Records that this process, or its reader program, has opened a regular file for reading. No output may replace this
/// file (tessera/program/output_file.hpp), and all ranks must have the same file (api/same_files.hpp). May be called
/// from any thread.
void note_read(const std::filesystem::path& file);

/// Only protects the file from being replaced by outputs. For files to which an input refers and which this run may not
/// open.
void note_named(const std::filesystem::path& file);

/// Whether the file with this device and inode number has been read.
bool was_read(std::uint64_t device, std::uint64_t number);

/// Returns the names of the files read since the last call, sorted, each once.
std::vector<std::string> take_names_read();

}  // namespace tessera::system
