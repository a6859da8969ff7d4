// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tessera::system {

/// A file for as long as this object lives, in the folder for temporary files (TMPDIR, else /tmp), that other processes
/// of this machine can open. It has no name in that folder, so that nothing is left of it whatever ends this process;
/// who has opened it may read on when this object is gone.
class ScratchFile {
 public:
  /// Room for `bytes` bytes, asked for at once where the file system can say. Throws Error(bad_input), as write() does,
  /// if there is no such folder or no room in it: `subject`, the input that is kept there, what is wrong, what to do.
  ScratchFile(std::string subject, std::uint64_t bytes);
  ~ScratchFile();
  /// Whether there is, for so many bytes and some more, as far as can be known before they are written.
  static bool has_room(std::uint64_t bytes);
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  void write(const void* bytes, std::size_t count);
  /// The same at a place, by any number of threads.
  void write_at(std::uint64_t position, const void* bytes, std::size_t count) const;
  void write(std::string_view text) { write(text.data(), text.size()); }
  void seek(std::uint64_t position) { position_ = position; }
  [[nodiscard]] std::uint64_t position() const { return position_; }

  /// By which processes of the same user and machine (of the same container) open it: this process's number and its
  /// file's.
  [[nodiscard]] std::filesystem::path path() const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// That there is room for.
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
