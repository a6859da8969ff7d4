// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "tessera/error.hpp"

namespace tessera {
inline namespace v0_1 {

/// An output cannot be written. The code depends on the time: Error(bad_input) if the user can correct it (missing
/// directory, no permission, the target is a directory or device) and nothing has been written; a caller that has
/// already checked that the output can be written calls since_changed().
class OutputFault : public Error {
 public:
  OutputFault(ErrorCode code, const std::filesystem::path& target, const std::string& fault, const char* remedy);
  OutputFault(const OutputFault&) = default;
  OutputFault& operator=(const OutputFault&) = default;
  ~OutputFault() override;  // defined in one place, as for Error
  /// The same as Error(system_failure): something has removed or closed the directory since.
  [[nodiscard]] Error since_changed() const;
};

/// For use before a run: creates the temporary file of an AtomicFile and removes it. Throws a plain Error instead of
/// OutputFault, so that errors of the run can be distinguished from earlier ones.
void check_writable(const std::filesystem::path& target);

/// An output file that appears complete, by rename, or not at all.
///
/// Data are written to a nameless file in the target's directory (O_TMPFILE), so that even a killed process leaves
/// nothing; if the file system does not support that, to `.tessera-PID-N.part` next to the target, which the destructor
/// removes. Only commit() makes the target appear, or replaces it, after fsync. Throws OutputFault: bad_input only from
/// the constructor, system_failure for a full or failing disk and for any error after the constructor. The messages
/// name the target.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Position of the next byte, counted from the beginning; going back overwrites (OpenEXR's line table).
  void seek(std::uint64_t position);
  [[nodiscard]] std::uint64_t position() const { return position_; }

  void commit();

  /// The open file, for programs that write to it; valid until commit().
  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// For libraries that open their output by name: the path to write to until commit(). The file is no longer nameless:
  /// a killed process leaves the `.part` behind, unless it called abandon_outputs().
  std::filesystem::path named_part();

 private:
  void open_named();
  [[noreturn]] void fail(int error_number, const char* doing) const;

  std::filesystem::path target_, part_;  ///< part_ is empty while the file is nameless
  int descriptor_ = -1;
  bool begun_ = false;
  std::uint64_t position_ = 0;
};

/// For a program that exits during a run without running destructors (Ctrl-C): removes the `.part` files of this
/// process's AtomicFiles, ends the program that encodes a film, and prevents any further output: a thread that calls
/// commit() waits until the process ends. May be called from any thread, but not from a signal handler.
void abandon_outputs() noexcept;

/// Writes a whole text file, or nothing. Throws as AtomicFile.
void write_text(const std::filesystem::path& target, std::string_view text);

/// From now on no output of this process replaces a file that it, or a reader program on its behalf, has opened for
/// reading, including files named by other files: AtomicFile throws. For programs that do one job and end.
void protect_inputs();
/// Throws Error(bad_input) if `target` has been read since protect_inputs(), by any name.
void check_not_read(const std::filesystem::path& target);

/// For use before a run: check_writable(), and checks that `target` is not this input (empty: none). Throws
/// Error(bad_input).
void check_output(const std::filesystem::path& target, const std::filesystem::path& input);
/// Only the second part of check_output(): throws if both are the same file.
void check_not_input(const std::filesystem::path& target, const std::filesystem::path& input);

}  // namespace v0_1
}  // namespace tessera
