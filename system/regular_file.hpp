// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "system/descriptor.hpp"

namespace tessera::system {

/// Opens a regular file to be read. Throws Error(bad_input, "NAME: ...") for one that is not there, may not be read or
/// is not regular: a pipe would be waited for without end. Error(system_failure) if this process or the machine has no
/// descriptor or memory left, or the disk fails.
Descriptor open_regular(const std::filesystem::path& file, const std::string& name);

/// Size in bytes of an open file. Throws Error(system_failure) if it cannot be determined.
std::uint64_t file_size(const Descriptor& opened, const std::string& name);

/// Up to `count` bytes from the beginning; fewer if it ends before.
std::string beginning_of(const Descriptor& file, std::uint64_t count);

/// Extension in lower case, with the dot.
std::string lower_extension(const std::filesystem::path& file);

}  // namespace tessera::system
