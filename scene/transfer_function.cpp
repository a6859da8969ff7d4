// SPDX-License-Identifier: BSD-3-Clause
#include "scene/transfer_function.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/error.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

using scene::bad_input;

bool emits(const Knot& k) { return k.color.x > 0 || k.color.y > 0 || k.color.z > 0; }

/// Limits far beyond any visible value. With them, light and optical depth are finite along rays of any length, in
/// single precision.
constexpr double most_color = 1e30, most_extinction = 1e100;

void check(const Knot& knot, std::size_t number) {
  if (!std::isfinite(knot.value)) throw bad_input(fmt::format("knot {}: the value is not finite", number));
  for (int i = 0; i < 3; ++i)
    if (!(knot.color[i] >= 0 && knot.color[i] <= most_color))
      throw bad_input(
          fmt::format("knot {}: colour component {}; it must be 0 to {}", number, knot.color[i], most_color));
  if (!(knot.extinction >= 0 && knot.extinction <= most_extinction))
    throw bad_input(
        fmt::format("knot {}: extinction {}; it must be 0 to {}", number, knot.extinction, most_extinction));
}

}  // namespace

TransferFunction::TransferFunction(std::vector<Knot> knots) {
  if (knots.empty()) throw bad_input("no knots; give at least one");
  for (std::size_t i = 0; i < knots.size(); ++i) {
    check(knots[i], i + 1);
    if (i > 0 && knots[i].value < knots[i - 1].value)
      throw bad_input(fmt::format("knot {}: value {} is below the value before it, {}; sort the knots", i + 1,
                                  knots[i].value, knots[i - 1].value));
    // The slope between neighbours as close as this would not be finite.
    if (i > 0 && knots[i].value - knots_.back().value < std::numeric_limits<double>::min())
      knots[i].value = knots_.back().value;
    const std::size_t n = knots_.size();
    if (n >= 2 && knots_[n - 1].value == knots[i].value && knots_[n - 2].value == knots[i].value)
      knots_.back() = knots[i];
    else
      knots_.push_back(knots[i]);
  }
  visible_knots_before_.resize(knots_.size() + 1, 0);
  emitting_knots_before_.resize(knots_.size() + 1, 0);
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    visible_knots_before_[i + 1] = visible_knots_before_[i] + (knots_[i].extinction > 0 ? 1 : 0);
    emitting_knots_before_[i + 1] = emitting_knots_before_[i] + (emits(knots_[i]) ? 1 : 0);
  }
}

Knot TransferFunction::evaluate(double s) const {
  if (std::isnan(s) || knots_.empty()) return {s, glm::dvec3(0), 0};
  const auto above =
      std::upper_bound(knots_.begin(), knots_.end(), s, [](double v, const Knot& k) { return v < k.value; });
  if (above == knots_.begin()) return {s, knots_.front().color, knots_.front().extinction};
  const Knot& low = *(above - 1);
  if (above == knots_.end() || low.value == s) return {s, low.color, low.extinction};
  const Knot& high = *above;
  // The differences are halved, because high - low may overflow for values near the ends of the range of double.
  const double u = (s * 0.5 - low.value * 0.5) / (high.value * 0.5 - low.value * 0.5);
  return {s, low.color + (high.color - low.color) * u, low.extinction + (high.extinction - low.extinction) * u};
}

bool TransferFunction::visible(double low, double high, bool emits_without_extinction) const {
  const auto shows = [&](const Knot& k) { return k.extinction > 0 || (emits_without_extinction && emits(k)); };
  if (shows(evaluate(low)) || shows(evaluate(high))) return true;
  // Between the two ends, the function is positive only if it is positive at a knot strictly inside or at the lower
  // knot of a step at `high`, whose value the function approaches.
  const auto begin =
      std::upper_bound(knots_.begin(), knots_.end(), low, [](double v, const Knot& k) { return v < k.value; });
  const auto end =
      std::upper_bound(knots_.begin(), knots_.end(), high, [](double v, const Knot& k) { return v < k.value; });
  if (begin >= end) return false;
  const auto i = static_cast<std::size_t>(begin - knots_.begin()), j = static_cast<std::size_t>(end - knots_.begin());
  return visible_knots_before_[j] > visible_knots_before_[i] ||
         (emits_without_extinction && emitting_knots_before_[j] > emitting_knots_before_[i]);
}

double TransferFunction::max_extinction() const {
  double most = 0;
  for (const Knot& k : knots_) most = std::max(most, k.extinction);
  return most;
}

double TransferFunction::max_color() const {
  double most = 0;
  for (const Knot& k : knots_) most = std::max({most, k.color.x, k.color.y, k.color.z});
  return most;
}

}  // namespace v0_1
}  // namespace tessera
