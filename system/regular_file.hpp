// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "system/descriptor.hpp"

namespace tessera::system {

/// Opens a regular file for reading. Throws Error(bad_input), whose message begins with `name`, for a file that is
/// missing, unreadable or not regular; reading a pipe could block forever. Throws Error(system_failure) if this process
/// or the machine runs out of descriptors or memory, or if the disk fails.
Descriptor open_regular(const std::filesystem::path& file, const std::string& name);

/// Size in bytes of an open file. Throws Error(system_failure) if it cannot be determined.
std::uint64_t file_size(const Descriptor& opened, const std::string& name);

/// Returns the first `count` bytes, or fewer if the file is shorter.
std::string beginning_of(const Descriptor& file, std::uint64_t count);

/// Returns the extension in lower case, with the dot.
std::string lower_extension(const std::filesystem::path& file);

}  // namespace tessera::system
