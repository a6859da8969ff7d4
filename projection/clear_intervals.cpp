// SPDX-License-Identifier: BSD-3-Clause
#include "projection/clear_intervals.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace tessera::projection {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double above(double v) { return std::nextafter(v, infinity); }
double below(double v) { return std::nextafter(v, -infinity); }

/// Returns an integer for a double, such that the integers have the order of the doubles.
std::int64_t number_of(double v) {
  const auto bits = std::bit_cast<std::int64_t>(v);
  return bits >= 0 ? bits : std::numeric_limits<std::int64_t>::min() - bits;
}
double numbered(std::int64_t n) {
  return std::bit_cast<double>(n >= 0 ? n : std::numeric_limits<std::int64_t>::min() - n);
}

/// Returns the last double of [low, high] at which `holds` is true. `holds` must change once, from true at `low` to
/// false at `high`.
template <class Predicate>
double last_where(double low, double high, Predicate holds) {
  std::int64_t yes = number_of(low), no = number_of(high);
  for (;;) {
    const std::uint64_t between = static_cast<std::uint64_t>(no) - static_cast<std::uint64_t>(yes);
    if (between <= 1) break;
    const std::int64_t middle = static_cast<std::int64_t>(static_cast<std::uint64_t>(yes) + between / 2);
    (holds(numbered(middle)) ? yes : no) = middle;
  }
  return numbered(yes);
}

}  // namespace

ClearIntervals::ClearIntervals(const scene::TransferFunction& function, bool emits_without_extinction,
                               std::span<const double> boundaries) {
  const auto shows = [&](const scene::Knot& k) {
    return k.extinction > 0 || (emits_without_extinction && (k.color.x > 0 || k.color.y > 0 || k.color.z > 0));
  };
  const auto clear_at = [&](double s) { return !shows(function.evaluate(s)); };
  const auto knots = function.knots();
  if (knots.empty()) {
    add(-infinity, infinity, false);
    part(boundaries);
    return;
  }
  if (!shows(knots.front())) add(-infinity, below(knots.front().value), false);
  for (std::size_t i = 0; i < knots.size();) {
    const scene::Knot& from_below = knots[i];
    const bool step = i + 1 < knots.size() && knots[i + 1].value == knots[i].value;
    i += step ? 2 : 1;
    const scene::Knot& at = knots[i - 1];
    if (!shows(at)) add(at.value, at.value, !shows(from_below));
    if (i == knots.size()) break;
    const scene::Knot& next = knots[i];
    const double low = above(at.value), high = below(next.value);
    if (low > high) continue;  // the two values are neighbours: there is no double between them
    if (!shows(at) && !shows(next)) {
      add(low, high, true);
    } else if (!shows(at) && clear_at(low)) {
      add(low, clear_at(high) ? high : last_where(low, high, clear_at), true);
    } else if (shows(at) && clear_at(high)) {  // even a visible `next` may vanish: rounding loses 1e-16 of `at`
      add(clear_at(low) ? low : above(last_where(low, high, [&](double s) { return !clear_at(s); })), high, true);
    }
  }
  if (!shows(knots.back())) add(above(knots.back().value), infinity, true);
  part(boundaries);
}

void ClearIntervals::add(double low, double high, bool joins) {
  if (joins && !intervals_.empty() && above(intervals_.back().high) == low)
    intervals_.back().high = high;
  else
    intervals_.push_back({low, high});
}

void ClearIntervals::part(std::span<const double> boundaries) {
  if (boundaries.empty()) return;
  std::vector<Interval> parts;
  for (Interval rest : intervals_) {
    for (auto b = std::upper_bound(boundaries.begin(), boundaries.end(), rest.low);
         b != boundaries.end() && *b <= rest.high; ++b) {
      if (*b == rest.low) continue;  // the boundary occurs twice
      parts.push_back({rest.low, below(*b)});
      rest.low = *b;
    }
    parts.push_back(rest);
  }
  intervals_ = std::move(parts);
}

std::span<const ClearIntervals::Interval> ClearIntervals::meeting(double low, double high) const {
  const auto begin =
      std::partition_point(intervals_.begin(), intervals_.end(), [&](const Interval& i) { return i.high < low; });
  const auto end = std::partition_point(begin, intervals_.end(), [&](const Interval& i) { return i.low <= high; });
  return {begin, end};
}

bool ClearIntervals::hold(double low, double high) const {
  const auto met = meeting(low, high);
  return !met.empty() && met.front().low <= low && high <= met.front().high;
}

}  // namespace tessera::projection
