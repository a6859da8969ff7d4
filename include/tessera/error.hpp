// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

/// Kinds of errors. The values are also the exit statuses of the program `tessera`.
enum class ErrorCode : int {
  bad_input = 2,       ///< a file or a setting is wrong; the caller can correct this
  system_failure = 3,  ///< disk, memory, a device, a lost rank
};

/// The only exception type that Tessera throws. An error consists of a subject, a problem and a remedy.
///
///     jet_0040.vtu: cell 1042 uses vertex 98713, the file holds 98304; write cells and points from one time step
///     `deep_accuracy` 0.5: it must be 1e-6 to 1
///
/// Subject  a file, a rank, a device or a setting, possibly with its value.
/// Problem  what is wrong and where.
/// Remedy   what to do; empty if the problem already implies it.
///
/// Names of settings are in backquotes and spelled as in C++, in the remedy too: "raise `memory`". The program prints
/// the option instead of the name, here --memory. Other text in backquotes must not be the name of a setting. A line
/// may name several settings. If the line begins with a name, the error is about that setting, and setting() returns
/// the name.
///
/// what() returns the whole error as one line, `SUBJECT: PROBLEM; REMEDY`, without the separator of an empty part. The
/// functions that return parts return views into what(), which are valid as long as the error exists.
class TESSERA_EXPORT Error : public std::runtime_error {
 public:
  /// Splits `line` into the parts. The remedy is the text after the last "; ". The subject is the text before the first
  /// ": ", unless that separator comes after the last "; ". A line without one of these separators has an empty subject
  /// or remedy. File names may contain both separators; callers that have the separate parts should use the other
  /// constructor.
  Error(ErrorCode code, const std::string& line);
  /// Joins the parts into one line. `problem` is never empty.
  Error(ErrorCode code, std::string_view subject, std::string_view problem, std::string_view remedy);

  Error(const Error&) = default;
  Error& operator=(const Error&) = default;
  ~Error() override;  // defined in one source file, so that all binaries share one type identity

  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  [[nodiscard]] std::string_view subject() const noexcept;
  [[nodiscard]] std::string_view problem() const noexcept;
  [[nodiscard]] std::string_view remedy() const noexcept;
  /// The setting that is wrong, without backquotes; empty if the error is not about a setting.
  [[nodiscard]] std::string_view setting() const noexcept;

 private:
  ErrorCode code_;
  std::size_t subject_end_ = 0, problem_begin_ = 0, problem_end_ = 0, remedy_begin_ = 0;  ///< offsets in what()
};

/// Makes the most frequent kind of error: a file or a setting is wrong. `line` is split as by the first constructor of
/// Error.
inline Error bad_input(const std::string& line) { return {ErrorCode::bad_input, line}; }

/// Converts any exception to an Error. An Error is returned unchanged. Any other exception becomes an
/// Error(system_failure) that reports a lack of memory or threads, or an unexpected exception.
TESSERA_EXPORT Error error_of(const std::exception_ptr& thrown);

}  // namespace v0_1
}  // namespace tessera
