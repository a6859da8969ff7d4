// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// What is said on stderr beside errors: lines that fit a terminal, numbers that say something.
namespace tessera::apps {

inline constexpr std::size_t most_columns = 160;

/// A statement as lines of at most 160 columns: broken at "; ", whose parts stay whole where they can, else at blanks,
/// and words that are longer than a line where the line ends. Later lines are indented by two blanks. No line break at
/// the end.
std::string in_lines(std::string_view statement);

/// Prints it so, standard input by its name, and printable() whatever the files say that are named in it.
void say_lines(std::string_view statement);

/// `1.23 s` from a second on, else `45.6 ms`.
std::string time_words(double milliseconds);

/// The significant digits, 6 to 17, by which numbers of `size` that differ by `extent` differ in at least four.
int digits_for(double size, double extent);

/// `LOW to HIGH`, with as many digits as tell them apart.
std::string range_words(double low, double high);

}  // namespace tessera::apps
