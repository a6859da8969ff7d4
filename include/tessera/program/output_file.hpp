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

/// The error for an output that cannot be written. It is Error(bad_input) if the user can correct the cause (a missing
/// directory, no permission, a target that is a directory or device) and nothing has been written yet. A caller that
/// had already checked that the output can be written calls since_changed().
class OutputFault : public Error {
 public:
  OutputFault(ErrorCode code, const std::filesystem::path& target, const std::string& fault, const char* remedy);
  OutputFault(const OutputFault&) = default;
  OutputFault& operator=(const OutputFault&) = default;
  ~OutputFault() override;  // defined in one source file, for the same reason as the destructor of Error
  /// Returns the error as Error(system_failure), because the directory was removed or made inaccessible after the
  /// check.
  [[nodiscard]] Error since_changed() const;
};

/// For use before a run: creates the temporary file of an AtomicFile and removes it. Throws an Error that is not an
/// OutputFault, so that errors before the run can be distinguished from those during the run.
void check_writable(const std::filesystem::path& target);

/// An output file that appears complete, by rename, or not at all.
///
/// Data are written to a nameless file in the target's directory (O_TMPFILE), so that even a killed process leaves no
/// file. If the file system does not support such files, data are written to `.tessera-PID-N.part` next to the target,
/// which the destructor removes. Only commit() makes the target appear, or replaces it, after fsync. Throws
/// OutputFault: bad_input only from the constructor, system_failure for a full or failing disk and for any error after
/// the constructor. The messages contain the name of the target.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Sets the position of the next byte, counted from the beginning of the file. Writing at an earlier position
  /// overwrites data; OpenEXR does so for its line table.
  void seek(std::uint64_t position);
  [[nodiscard]] std::uint64_t position() const { return position_; }

  void commit();

  /// Descriptor of the open file, for programs that write to it; valid until commit().
  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// Returns the path of the file until commit(), for libraries that open their output by name. After the call the file
  /// is no longer nameless: if the process is killed, the `.part` file remains, unless abandon_outputs() was called.
  std::filesystem::path named_part();

 private:
  void open_named();
  [[noreturn]] void fail(int error_number, const char* doing) const;

  std::filesystem::path target_, part_;  ///< part_ is empty while the file is nameless
  int descriptor_ = -1;
  bool begun_ = false;
  std::uint64_t position_ = 0;
};

/// For a program that exits during a run without running destructors (Ctrl-C). Removes the `.part` files of this
/// process's AtomicFiles, ends the program that encodes a film, and prevents further output: a thread that calls
/// commit() waits until the process ends. May be called from any thread, but not from a signal handler.
void abandon_outputs() noexcept;

/// Writes a text file, completely or not at all. Throws the same errors as AtomicFile.
void write_text(const std::filesystem::path& target, std::string_view text);

/// From now on, AtomicFile throws instead of replacing a file that this process, or a reader program on its behalf, has
/// opened for reading. This includes files to which other files refer. For programs that do one job and end.
void protect_inputs();
/// Throws Error(bad_input) if the file `target` has been read, under any name, since protect_inputs().
void check_not_read(const std::filesystem::path& target);

/// For use before a run: calls check_writable() and check_not_input(). If `input` is empty, there is no input. Throws
/// Error(bad_input).
void check_output(const std::filesystem::path& target, const std::filesystem::path& input);
/// Throws Error(bad_input) if `target` and `input` are the same file.
void check_not_input(const std::filesystem::path& target, const std::filesystem::path& input);

}  // namespace v0_1
}  // namespace tessera
