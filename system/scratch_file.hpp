// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tessera::system {

/// A temporary file in the directory for temporary files (TMPDIR or, if that is not set, /tmp), with the lifetime of
/// this object. Other processes of this machine can open the file. It has no name in that directory, so that nothing
/// remains of it, however this process ends. A process that has opened the file may continue to read it after this
/// object is destroyed.
class ScratchFile {
 public:
  /// Reserves `bytes` bytes at once if the file system supports this. `subject` is the input that is stored in the
  /// file. Like write(), throws Error(bad_input), with `subject`, the reason and a remedy, if the directory is missing
  /// or full.
  ScratchFile(std::string subject, std::uint64_t bytes);
  ~ScratchFile();
  /// Whether there is space for `bytes` bytes and some more, as far as this can be determined before writing.
  static bool has_room(std::uint64_t bytes);
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  void write(const void* bytes, std::size_t count);
  /// Writes at a position. May be called from any number of threads at the same time.
  void write_at(std::uint64_t position, const void* bytes, std::size_t count) const;
  void write(std::string_view text) { write(text.data(), text.size()); }
  void seek(std::uint64_t position) { position_ = position; }
  [[nodiscard]] std::uint64_t position() const { return position_; }

  /// The path with which processes of the same user on the same machine (in the same container) open the file. It
  /// consists of the id of this process and the descriptor.
  [[nodiscard]] std::filesystem::path path() const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// The size that was reserved.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  [[noreturn]] void fail(int error_number) const;

  std::string subject_;
  std::filesystem::path folder_;
  std::uint64_t bytes_, position_ = 0;
  int descriptor_ = -1;
};

/// "1.2 GB"
std::string size_in_words(std::uint64_t bytes);

}  // namespace tessera::system
