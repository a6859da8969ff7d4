// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Lines on stderr other than errors. They are broken to fit a terminal, and numbers have only significant digits.
namespace tessera::apps {

inline constexpr std::size_t most_columns = 160;

/// Breaks a statement into lines of at most 160 columns. Lines are broken at "; " if the parts are short enough,
/// otherwise at blanks; words that are longer than a line are cut. All lines but the first are indented by two blanks.
/// There is no line break at the end.
std::string in_lines(std::string_view statement);

/// Prints a statement in the form of in_lines() and printable(), since it may contain names from files. The name of the
/// file with standard input is replaced.
void print_lines(std::string_view statement);

/// `1.23 s` for a second and more, otherwise `45.6 ms`.
std::string time_words(double milliseconds);

/// Returns the number of significant digits, 6 to 17, with which numbers of magnitude `size` that differ by `extent`
/// differ in at least four digits.
int digits_for(double size, double extent);

/// `LOW to HIGH`, with as many digits as are needed to distinguish them.
std::string range_words(double low, double high);

}  // namespace tessera::apps
