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

/// An output cannot be written. Whose fault it is depends on when: Error(bad_input) where the user can mend it (no such
/// folder, no permission, the target is a folder or device), as long as nothing has been begun; who has found before
/// that it could be written calls since_changed().
class OutputFault : public Error {
 public:
  OutputFault(ErrorCode code, const std::filesystem::path& target, const std::string& fault, const char* remedy);
  OutputFault(const OutputFault&) = default;
  OutputFault& operator=(const OutputFault&) = default;
  ~OutputFault() override;  // defined in one place, as Error's
  /// The same as Error(system_failure): something has removed or closed the folder since.
  [[nodiscard]] Error since_changed() const;
};

/// Before a run: begins such a file as AtomicFile is, and leaves it. Throws a plain Error, which is not OutputFault, so
/// that a run's own faults can be told from those that were there before it.
void check_writable(const std::filesystem::path& target);

/// An output file that appears whole, by rename, or not at all.
///
/// Writing goes to a nameless file in the target's folder (O_TMPFILE), so that even a killed process leaves nothing;
/// where the file system has no such thing, to `.tessera-PID-N.part` beside the target, removed by the destructor.
/// Only commit() makes the target appear, or replaces it, after fsync. Throws OutputFault: bad_input only from the
/// constructor, system_failure for a full or failing disk and for whatever happens after the constructor. The messages
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

  /// For programs that are to write to it: the open file, until commit().
  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// For libraries that open their output by name: where they may write until commit(). Costs the nameless file its
  /// advantage: a killed process leaves the `.part` behind, unless it called abandon_outputs().
  std::filesystem::path named_part();

 private:
  void open_named();
  [[noreturn]] void fail(int error_number, const char* doing) const;

  std::filesystem::path target_, part_;  ///< part_ empty while nameless
  int descriptor_ = -1;
  bool begun_ = false;
  std::uint64_t position_ = 0;
};

/// For a program that ends in mid-run and runs no destructors (Ctrl-C): removes the `.part`s that AtomicFiles of this
/// process have, ends the program that makes a film, and lets no output appear any more: who commits one waits for the
/// end. From any thread, but not from a signal's handler.
void abandon_outputs() noexcept;

/// Writes all of a text file, whole or not at all. Throws as AtomicFile.
void write_text(const std::filesystem::path& target, std::string_view text);

/// From now on no output of this process replaces a file that it, or a reader program for it, has opened to read, also
/// those that a file names: AtomicFile throws. For programs that do one job and end.
void protect_inputs();
/// Throws Error(bad_input) if `target` has been read since protect_inputs(), by whatever name.
void check_not_read(const std::filesystem::path& target);

/// Before a run: check_writable(), and `target` is not this input (empty: none). Throws Error(bad_input).
void check_output(const std::filesystem::path& target, const std::filesystem::path& input);
/// That alone of it: throws if they are one file.
void check_not_input(const std::filesystem::path& target, const std::filesystem::path& input);

}  // namespace v0_1
}  // namespace tessera
