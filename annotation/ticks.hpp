// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// Round numbers for readers: 1, 2 or 5 times a power of ten.
namespace tessera::annotation {

/// A value on a scale and its label.
struct Tick {
  double value;
  std::string label;
};

/// The largest of 1, 2 and 5 times a power of ten that is at most `limit`; `limit` is positive and finite.
double round_length(double limit);

/// Returns the multiples of a round step in [low, high], ascending: as many as possible, but not more than `most`,
/// which is at least 2. Labels are exact and differ from each other. If low equals high, only that value is returned.
/// If doubles cannot distinguish multiples in the range, its ends are returned.
std::vector<Tick> linear_ticks(double low, double high, int most);

/// Returns ticks for a logarithmic scale, 0 < low <= high: all powers of ten in the range, or every n-th of them. If
/// fewer than two powers are in the range, returns linear_ticks().
std::vector<Tick> logarithmic_ticks(double low, double high, int most);

/// Returns the shortest form of a number with six significant digits.
std::string number_words(double value);

}  // namespace tessera::annotation
