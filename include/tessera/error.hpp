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

/// What kind of trouble an error is. The values are also what the program `tessera` exits with.
enum class ErrorCode : int {
  bad_input = 2,       ///< a file or a setting is wrong; the caller can mend it
  system_failure = 3,  ///< disk, memory, a device, a lost rank
};

/// The one exception of Tessera: what is concerned, what is wrong with it, and what to do.
///
///     jet_0040.vtu: cell 1042 uses vertex 98713, the file holds 98304; write cells and points from one time step
///     `deep_accuracy` 0.5: it must be 1e-6 to 1
///
/// Subject  a file, a rank, a device or a setting, perhaps with the value that it has.
/// Problem  what is wrong and where.
/// Remedy   what to do; empty where the problem says it already.
/// Settings stand in backquotes by their names in C++, in the remedy too: "raise `memory`". The program writes such a
/// name as the option that it is, --memory; no other text in backquotes is a setting's name. A line may name several;
/// one that begins with a name is about that setting: setting().
///
/// what() is the whole on one line, `SUBJECT: PROBLEM; REMEDY`, without the mark beside a part that is empty. The parts
/// lie in what() and live as long as the error.
class TESSERA_EXPORT Error : public std::runtime_error {
 public:
  /// Splits a line. The remedy is what follows the last "; ". The subject is what goes before the first ": ", unless
  /// that comes later than the last "; ". A line without the one or the other mark has an empty subject or remedy.
  /// File names may hold both marks: who has the parts gives them apart.
  Error(ErrorCode code, const std::string& line);
  /// Joins the parts to a line. `problem` is never empty.
  Error(ErrorCode code, std::string_view subject, std::string_view problem, std::string_view remedy);

  Error(const Error&) = default;
  Error& operator=(const Error&) = default;
  ~Error() override;  // defined in one place, so that the type has one identity in whatever links to it

  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  [[nodiscard]] std::string_view subject() const noexcept;
  [[nodiscard]] std::string_view problem() const noexcept;
  [[nodiscard]] std::string_view remedy() const noexcept;
  /// The setting that is wrong, without backquotes; empty where the error is not about one.
  [[nodiscard]] std::string_view setting() const noexcept;

 private:
  ErrorCode code_;
  std::size_t subject_end_ = 0, problem_begin_ = 0, problem_end_ = 0, remedy_begin_ = 0;  ///< places in what()
};

/// The most frequent one: a file or a setting is wrong. The line as Error's first constructor takes it.
inline Error bad_input(const std::string& line) { return {ErrorCode::bad_input, line}; }

/// What any exception is to the user: itself if it is an Error, else Error(system_failure): no more memory, no more
/// threads, or unexpected.
TESSERA_EXPORT Error error_of(const std::exception_ptr& thrown);

}  // namespace v0_1
}  // namespace tessera
