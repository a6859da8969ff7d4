// SPDX-License-Identifier: BSD-3-Clause
#include "integrals/lane_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace tessera::integrals {
namespace {

constexpr double scalar_limit = 0x1p30;
constexpr double largest_number = 1e18;

double channel_of(const scene::Knot& knot, int channel) {
  return channel == 0 ? knot.extinction : knot.color[channel - 1];
}

/// The function at one position of its knots: `below` when approached from below, `above` from above. The two differ at
/// a step.
struct Place {
  double position;
  scene::Knot below, above;
  std::array<double, 2> values;
  bool several = false, peak = false;
};

bool emits(const scene::Knot& knot, scene::Emission emission) {
  return knot.extinction > 0 ||
         (emission == scene::Emission::independent && std::max({knot.color.x, knot.color.y, knot.color.z}) > 0);
}

/// Returns the least float that is not below (value - origin) / unit.
double lane_at_or_above(double value, double origin, double unit) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const double difference = value - origin, back = difference - value;
  const double rest = (value - (difference - back)) - (origin + back);  // rounding error by Knuth's two-sum
  const double exact = difference / unit;
  const auto below = [&](float f) { return f < exact || (f == exact && rest > 0); };
  auto f = static_cast<float>(exact);
  while (below(f)) f = std::nextafter(f, infinity);
  while (!below(std::nextafter(f, -infinity))) f = std::nextafter(f, -infinity);
  return f;
}

std::vector<Place> places_of(const scene::TransferFunction& function, double origin, double unit, StepRounding steps,
                             scene::Emission emission) {
  std::vector<Place> places;
  const auto add = [&](double position, const scene::Knot& knot) {
    if (places.empty() || places.back().position < position) {
      places.push_back({position, knot, knot, {knot.value, knot.value}});
    } else {
      Place& place = places.back();
      place.peak = place.peak || (place.several && emits(place.above, emission));
      place.above = knot, place.values[1] = knot.value, place.several = true;
    }
  };
  const auto knots = function.knots();
  const auto position = [&](const scene::Knot& knot) { return (knot.value - origin) / unit; };
  // Knots beyond the representable range are replaced by the function's value at the end of that range.
  if (position(knots.front()) < -scalar_limit) add(-scalar_limit, function.evaluate(origin - scalar_limit * unit));
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const scene::Knot& knot = knots[i];
    if (std::abs(position(knot)) > scalar_limit) continue;
    const bool step =
        (i > 0 && knots[i - 1].value == knot.value) || (i + 1 < knots.size() && knots[i + 1].value == knot.value);
    add(step && steps == StepRounding::up ? lane_at_or_above(knot.value, origin, unit)
                                          : lane_scalar(knot.value, origin, unit),
        knot);
  }
  if (position(knots.back()) > scalar_limit) add(scalar_limit, function.evaluate(origin + scalar_limit * unit));
  return places;
}

float bounded(double x) { return static_cast<float>(std::clamp(x, -largest_number, largest_number)); }

}  // namespace

float lane_scalar(double value, double scalar_origin, double scalar_unit) {
  const double n = std::nearbyint((value - scalar_origin) / scalar_unit);
  return static_cast<float>(static_cast<std::int32_t>(std::clamp(n, -scalar_limit, scalar_limit)));
}

LaneTable::LaneTable(const scene::TransferFunction& function, double scalar_origin, double scalar_unit,
                     double length_unit, scene::Emission emission_, StepRounding steps)
    : emission(emission_),
      color_unit(emission_ == scene::Emission::independent ? 1 / length_unit : 1),
      has_clear(false) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const std::vector<Place> places = places_of(function, scalar_origin, scalar_unit, steps, emission);
  knot_count = places.size();
  // There are at least four cells per knot, so that no two evenly spaced knots are in the same cell.
  std::vector<float> knots;
  knots.reserve(knot_count);
  for (const Place& place : places) knots.push_back(static_cast<float>(place.position));
  const std::size_t cells = std::bit_ceil(4 * knot_count);
  const float width = knots[knot_count - 1] - knots[0];
  grid_origin = knots[0];
  grid_scale = width > 0 ? static_cast<float>(cells) / width : 0.0f;
  last_cell = static_cast<float>(cells - 1);
  std::vector<std::size_t> in_cell(cells, 0);
  for (std::size_t i = 0; i < knot_count; ++i)
    ++in_cell[static_cast<std::size_t>(std::clamp((knots[i] - grid_origin) * grid_scale, 0.0f, last_cell))];
  std::size_t before = 0;
  for (const std::size_t n : in_cell) {
    knots_before.push_back(static_cast<std::int32_t>(before));
    before += n;
  }
  largest_step = std::bit_floor(*std::max_element(in_cell.begin(), in_cell.end()));
  // A search that starts at the last knot may read past this knot by the length of the first step of a search.
  stride = knot_count + 2 + std::max(padding, largest_step);
  rows.assign(column_count * stride, 0.0f);
  float* const edges = &rows[edge * stride];
  std::fill(edges, edges + stride, infinity);
  edges[0] = -infinity;
  edge_values.resize(knot_count + 1), is_step.assign(stride, 0), has_peak.assign(stride, 0);
  for (std::size_t i = 0; i < knot_count; ++i) {
    edges[i + 1] = static_cast<float>(places[i].position);
    const auto& [least, largest] = edge_values[i + 1] = places[i].values;
    is_step[i + 1] = places[i].several && least == largest;
    has_peak[i + 1] = places[i].peak;
  }

  for (std::size_t i = 0; i <= knot_count; ++i) {
    const Place &first = places[i == 0 ? 0 : i - 1], &second = places[i == knot_count ? i - 1 : i];
    const scene::Knot& low = i == 0 ? first.below : first.above;
    const scene::Knot& high = i == knot_count ? second.above : second.below;
    const double width = second.position - first.position;
    has_clear = has_clear || !(emits(low, emission) || emits(high, emission));
    const bool from_low = low.extinction <= high.extinction;
    rows[base * stride + i] = static_cast<float>(from_low ? first.position : second.position);
    for (int c = 0; c < 4; ++c) {
      const double unit = c == 0 ? 0.5 * length_unit : emission == scene::Emission::independent ? length_unit : 1.0;
      const double start = bounded(channel_of(low, c) * unit), end = bounded(channel_of(high, c) * unit);
      rows[static_cast<std::size_t>(half_extinction + 2 * c) * stride + i] = static_cast<float>(from_low ? start : end);
      rows[static_cast<std::size_t>(half_extinction_slope + 2 * c) * stride + i] =
          width > 0 ? static_cast<float>((end - start) / width) : 0.0f;
    }
  }

  is_moved.assign(stride, 0);
  for (std::size_t e = 1; e <= knot_count; ++e) {
    double moved = 0, steepest = 0;
    for (const double value : places[e - 1].values)
      moved = std::max(moved, std::abs((value - scalar_origin) / scalar_unit - edges[e]));
    const auto slope = [&](int c, std::size_t interval) {
      return std::abs(rows[static_cast<std::size_t>(c) * stride + interval]);
    };
    for (const std::size_t interval : {e - 1, e}) {
      steepest = std::max(steepest, 2.0 * slope(half_extinction_slope, interval));
      if (emission == scene::Emission::independent)
        for (const int c : {red_slope, green_slope, blue_slope})
          steepest = std::max<double>(steepest, slope(c, interval));
    }
    is_moved[e] = places[e - 1].values[0] < places[e - 1].values[1] || moved * steepest > 1e-7;
  }

  const auto knots_of = function.knots();
  for (std::size_t i = 1; i < knots_of.size(); ++i) has_steps = has_steps || knots_of[i].value == knots_of[i - 1].value;
}

}  // namespace tessera::integrals
