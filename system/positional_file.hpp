// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "system/descriptor.hpp"

namespace tessera::system {

/// An open file that any number of threads read by position. The name is no longer needed after opening: a file that is
/// removed can still be read to the end.
class PositionalFile {
 public:
  /// `name` for messages; empty: the file's. Throws like open_regular (system/regular_file.hpp).
  explicit PositionalFile(const std::filesystem::path& file, std::string name = {});

  /// `count` bytes from byte `at` on. Throws Error(system_failure) if the file ends earlier, or the disk fails.
  void read(std::uint64_t at, std::byte* to, std::uint64_t count) const;

  /// Up to `count` bytes from the beginning; fewer if the file is shorter.
  [[nodiscard]] std::string beginning(std::uint64_t count) const;

  [[nodiscard]] std::uint64_t size() const;
  [[nodiscard]] int descriptor() const { return descriptor_.get(); }

 private:
  [[noreturn]] void fail(const std::string& what, int error_number) const;

  std::string name_;
  Descriptor descriptor_;
};

}  // namespace tessera::system
