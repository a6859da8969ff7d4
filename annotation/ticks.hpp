// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// Round numbers for people: 1, 2 or 5 times a power of ten.
namespace tessera::annotation {

/// A value on a scale and how it is written.
struct Tick {
  double value;
  std::string label;
};

/// The largest number of 1, 2 and 5 times a power of ten that is at most `limit`; `limit` is positive and finite.
double round_length(double limit);

/// Multiples of a round step in [low, high], ascending, at most `most` (at least 2) and as many of them as that allows.
/// Labels are exact and differ from each other. low == high: that value alone. A range too narrow for doubles to tell
/// multiples apart gives its ends.
std::vector<Tick> linear_ticks(double low, double high, int most);

/// For a logarithmic scale, 0 < low <= high: powers of ten, each or every so many; where fewer than two are in the
/// range, linear_ticks().
std::vector<Tick> logarithmic_ticks(double low, double high, int most);

/// A number as briefly as it reads back to six digits.
std::string number_words(double value);

}  // namespace tessera::annotation
