// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "system/descriptor.hpp"

namespace tessera::system {

/// An open file that any number of threads may read at given positions. The name is not needed after opening: a file
/// that has been removed can still be read.
class PositionalFile {
 public:
  /// `name` is the name in messages; if it is empty, that of the file is used. Throws the same errors as open_regular()
  /// (system/regular_file.hpp).
  explicit PositionalFile(const std::filesystem::path& file, std::string name = {});

  /// Reads `count` bytes, beginning at byte `at`. Throws Error(system_failure) if the file ends earlier or the disk
  /// fails.
  void read(std::uint64_t at, std::byte* to, std::uint64_t count) const;

  /// Returns the first `count` bytes, or fewer if the file is shorter.
  [[nodiscard]] std::string beginning(std::uint64_t count) const;

  [[nodiscard]] std::uint64_t size() const;
  [[nodiscard]] int descriptor() const { return descriptor_.get(); }

 private:
  [[noreturn]] void fail(const std::string& what, int error_number) const;

  std::string name_;
  Descriptor descriptor_;
};

}  // namespace tessera::system
