// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace tessera::test {

/// The bytes under test as a file, in memory if the system supports it, for readers that take files.
class FuzzFile {
 public:
  /// The extension matters if the beginning does not determine the format.
  explicit FuzzFile(const std::string& extension) {
    const std::filesystem::path memory = "/dev/shm";
    const auto folder = std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
    path = folder / ("tessera_fuzz_" + std::to_string(getpid()) + extension);
  }
  ~FuzzFile() { std::filesystem::remove(path); }
  FuzzFile(const FuzzFile&) = delete;
  FuzzFile& operator=(const FuzzFile&) = delete;
  void write(const std::uint8_t* data, std::size_t size) const {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
  std::filesystem::path path;
};

}  // namespace tessera::test
