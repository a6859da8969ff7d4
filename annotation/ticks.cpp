// SPDX-License-Identifier: BSD-3-Clause
#include "annotation/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessera::annotation {
namespace {

/// m times ten to the e, with m of 1, 2, 5: a step between ticks.
struct Step {
  int mantissa, exponent;

  /// The double nearest to k steps, except with powers of ten that are not exact.
  [[nodiscard]] double times(double k) const {
    const double multiple = k * mantissa;
    // A division by an exact power of ten is rounded once; a product with an inexact one twice.
    return exponent >= 0     ? multiple * std::pow(10.0, exponent)
           : exponent > -300 ? multiple / std::pow(10.0, -exponent)
                             : multiple / 1e300 / std::pow(10.0, -exponent - 300);
  }
  [[nodiscard]] Step next() const {
    return mantissa == 1 ? Step{2, exponent} : mantissa == 2 ? Step{5, exponent} : Step{1, exponent + 1};
  }
};

/// The largest step at most `limit`.
Step step_at_most(double limit) {
  Step step{1, static_cast<int>(std::floor(std::log10(limit))) - 1};  // log10 may be off by one ulp
  while (step.next().times(1) <= limit) step = step.next();
  return step;
}

/// 1.50e+07 becomes 1.5e7; text without an exponent does not change.
std::string brief(const std::string& text) {
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return text;
  std::string mantissa = text.substr(0, e);
  if (mantissa.find('.') != std::string::npos) {
    while (mantissa.back() == '0') mantissa.pop_back();
    if (mantissa.back() == '.') mantissa.pop_back();
  }
  return fmt::format("{}e{}", mantissa, std::stoi(text.substr(e + 1)));
}

/// A power of ten as in label_of(), but shorter if that has five characters or more.
std::string power_label(int e) {
  return e < -3 || e > 4 ? fmt::format("1e{}", e) : fmt::format("{:.{}f}", std::pow(10.0, e), std::max(-e, 0));
}

/// A number with the decimals of ten to the `exponent`.
std::string label_of(double value, int exponent) {
  const double size = std::abs(value);
  if (size == 0 && exponent < -4) return "0";
  if (size == 0 || (size >= 1e-4 && size < 1e6)) return fmt::format("{:.{}f}", value, std::max(-exponent, 0));
  const int digits = std::clamp(static_cast<int>(std::floor(std::log10(size) + 1e-9)) - exponent, 0, 16);
  return brief(fmt::format("{:.{}e}", value, digits));
}

}  // namespace

double round_length(double limit) { return step_at_most(limit).times(1); }

std::string number_words(double value) { return brief(fmt::format("{:.6g}", value + 0.0)); }  // no -0

std::vector<Tick> linear_ticks(double low, double high, int most) {
  if (low == high) return {{low, number_words(low)}};
  most = std::max(most, 2);
  const double largest = std::max(std::abs(low), std::abs(high));
  const double width = high / 2 - low / 2;  // halves, so that 1e308 does not overflow
  if (width <= largest * 1e-12) return {{low, brief(fmt::format("{}", low))}, {high, brief(fmt::format("{}", high))}};
  // Ends that are multiples up to rounding count.
  constexpr double slack = 1e-6;
  const auto first_of = [&](const Step& s) { return std::ceil(low / s.times(1) - slack) + 0.0; };  // no -0
  const auto last_of = [&](const Step& s) { return std::floor(high / s.times(1) + slack); };
  Step step = step_at_most(width / most * 2);
  while (last_of(step) - first_of(step) + 1 > most) step = step.next();
  const double first = first_of(step);
  const int count = static_cast<int>(last_of(step) - first) + 1;
  std::vector<Tick> ticks;
  for (int i = 0; i < count; ++i) {
    const double multiple = step.times(first + i);
    ticks.push_back({std::clamp(multiple, low, high), label_of(multiple, step.exponent)});
  }
  return ticks;
}

std::vector<Tick> logarithmic_ticks(double low, double high, int most) {
  if (low == high) return {{low, number_words(low)}};
  most = std::max(most, 2);
  const int first = static_cast<int>(std::ceil(std::log10(low) - 1e-12));
  const int last = static_cast<int>(std::floor(std::log10(high) + 1e-12));
  if (last <= first) return linear_ticks(low, high, most);
  // Multiples of `every`, so that 1 is among them if it is in the range.
  const auto multiples = [&](int every) {
    return static_cast<int>(std::floor(double(last) / every) - std::ceil(double(first) / every)) + 1;
  };
  int every = 1;
  while (multiples(every) > most) ++every;
  std::vector<Tick> ticks;
  for (int e = first; e <= last; ++e)
    if (e % every == 0) ticks.push_back({std::clamp(Step{1, e}.times(1), low, high), power_label(e)});
  if (ticks.size() < 2) {
    ticks.clear();
    for (const int e : {first, last}) ticks.push_back({std::clamp(Step{1, e}.times(1), low, high), power_label(e)});
  }
  return ticks;
}

}  // namespace tessera::annotation
