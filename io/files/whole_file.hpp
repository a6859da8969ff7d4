// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace tessera::io {

/// A whole file in memory: a text file, or another file that is read completely. Throws like open_input
/// (input_file.hpp), and Error(system_failure) if the file is shortened while it is read.
///
/// The file is read, not mapped: if another program shortened a mapped file, this process would end with SIGBUS at an
/// unpredictable later time.
class WholeFile {
 public:
  explicit WholeFile(const std::filesystem::path& file);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  [[nodiscard]] std::string_view text() const { return {static_cast<const char*>(start_), size_}; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(start_), size_}; }

 private:
  void* start_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace tessera::io
