// SPDX-License-Identifier: BSD-3-Clause
#include "annotation/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessera::annotation {
namespace {

/// A step between ticks: `mantissa` (1, 2 or 5) times ten to the power of `exponent`.
struct Step {
  int mantissa, exponent;

  /// Returns k steps. The result is rounded correctly if the power of ten is exact as a double.
  [[nodiscard]] double times(double k) const {
    const double multiple = k * mantissa;
    // A division by an exact power of ten is rounded once; a multiplication by an inexact power is rounded twice.
    return exponent >= 0     ? multiple * std::pow(10.0, exponent)
           : exponent > -300 ? multiple / std::pow(10.0, -exponent)
                             : multiple / 1e300 / std::pow(10.0, -exponent - 300);
  }
  [[nodiscard]] Step next() const {
    return mantissa == 1 ? Step{2, exponent} : mantissa == 2 ? Step{5, exponent} : Step{1, exponent + 1};
  }
};

/// Returns the largest step that is at most `limit`.
Step step_at_most(double limit) {
  Step step{1, static_cast<int>(std::floor(std::log10(limit))) - 1};  // one less, because the result of log10 may be
                                                                      // off by one ulp
  while (step.next().times(1) <= limit) step = step.next();
  return step;
}

/// Shortens 1.50e+07 to 1.5e7. Text without an exponent does not change.
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

/// Returns the label of a power of ten as in label_of(), or a shorter form if that has five characters or more.
std::string power_label(int e) {
  return e < -3 || e > 4 ? fmt::format("1e{}", e) : fmt::format("{:.{}f}", std::pow(10.0, e), std::max(-e, 0));
}

/// Returns a number with as many decimals as ten to the power of `exponent` has.
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
  const double width = high / 2 - low / 2;  // numbers are halved so that 1e308 does not overflow
  if (width <= largest * 1e-12) return {{low, brief(fmt::format("{}", low))}, {high, brief(fmt::format("{}", high))}};
  // Ends of the range that are multiples up to rounding are included.
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
  // Only exponents that are multiples of `every` are used, so that 1 is among the values if it is in the range.
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
