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

/// Multiples of a round step in [low, high], ascending, as many as possible but at most `most` (at least 2). Labels are
/// exact and differ from each other. low == high: only that value. A range in which doubles cannot distinguish
/// multiples gives its ends.
std::vector<Tick> linear_ticks(double low, double high, int most);

/// For a logarithmic scale, 0 < low <= high: powers of ten, each or every n-th; if fewer than two are in the range,
/// linear_ticks().
std::vector<Tick> logarithmic_ticks(double low, double high, int most);

/// The shortest form of a number that reads back to six digits.
std::string number_words(double value);

}  // namespace tessera::annotation
