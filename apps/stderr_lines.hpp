// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Lines on stderr other than errors: they fit a terminal, and numbers have significant digits only.
namespace tessera::apps {

inline constexpr std::size_t most_columns = 160;

/// Breaks a statement into lines of at most 160 columns: at "; ", keeping the parts whole if possible, otherwise at
/// blanks; words that are longer than a line are cut. Later lines are indented by two blanks. No line break at the end.
std::string in_lines(std::string_view statement);

/// Prints it with in_lines() and printable(), since it may contain names from files; standard input has its own name.
void print_lines(std::string_view statement);

/// `1.23 s` for a second and more, otherwise `45.6 ms`.
std::string time_words(double milliseconds);

/// The number of significant digits, 6 to 17, for numbers of size `size` that differ by `extent` to differ in at least
/// four.
int digits_for(double size, double extent);

/// `LOW to HIGH`, with as many digits as distinguish them.
std::string range_words(double low, double high);

}  // namespace tessera::apps
