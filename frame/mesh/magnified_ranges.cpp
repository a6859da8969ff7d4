// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/magnified_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::frame {
namespace {

constexpr double plane_error = 16;       // lattice steps: gradients over a square
constexpr double float_error = 0x1p-24;  // half of a float's last place
constexpr std::size_t most_ranges = 8;
/// Each magnified range is as long as the mesh's range of scalars; this part of it is left free in front of each range.
constexpr double gap = 1.0 / 64;

struct Range {
  double low, high;
  double most_width;  ///< a wider range would not be magnified enough for its pieces
};

/// Returns the ranges of the pieces that the lattice does not resolve, ascending; nothing if a range would be too wide.
std::optional<std::vector<Range>> steep_ranges(const ScalarLattice& scalars, double low, double high,
                                               std::span<const FunctionPiece> pieces, double most_error) {
  // Just below a step or the end of a range, the error is a whole last place, as in resolves().
  const double error = 2 * scalars.reach * float_error;
  // Numbers at this distance are rounded to different floats: neighbouring floats are at most `error` apart.
  const double separate = 1.25 * error;
  std::vector<Range> ranges;
  for (const FunctionPiece& piece : pieces) {
    if (scalars.resolves(piece, most_error)) continue;
    // A range of width w is magnified by (high - low) / w.
    const double most_width =
        (piece.high - piece.low) * ((high - low) / std::max(separate, error * piece.change / most_error));
    const double begin = std::max(piece.low, low), end = std::min(piece.high, high);
    if (!ranges.empty()) {
      Range& last = ranges.back();
      const double limit = std::min(last.most_width, most_width);
      // Most cells with a scalar between two near ranges would reach both ranges.
      const bool near = begin - last.high <= last.high - last.low;
      if (near && end - last.low <= limit) {
        last = {last.low, std::max(last.high, end), limit};
        continue;
      }
    }
    if (end - begin > most_width) return std::nullopt;
    ranges.push_back({begin, end, most_width});
  }
  // The lower and upper end of touching ranges must be different floats, because these ends are also among the scalars
  // that are not moved.
  double begin = 0;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (i == 0 || ranges[i].low != ranges[i - 1].high) begin = ranges[i].low;
    const double next = i + 1 < ranges.size() ? ranges[i + 1].low : std::numeric_limits<double>::infinity();
    if (ranges[i].high == next) continue;
    ranges[i].high = std::max(ranges[i].high, begin + separate);
    if (ranges[i].high > next || ranges[i].high - ranges[i].low > ranges[i].most_width) return std::nullopt;
  }
  return ranges;
}

scene::Knot at(scene::Knot knot, double value) {
  knot.value = value;
  return knot;
}

/// The function just below `value`.
scene::Knot below(const scene::TransferFunction& function, double value) {
  const auto knots = function.knots();
  const auto knot = std::ranges::find(knots, value, &scene::Knot::value);
  return knot != knots.end() ? *knot : function.evaluate(value);
}

/// Returns the function without its knots in the ranges, followed by these knots at their new places.
scene::TransferFunction moved_knots(const scene::TransferFunction& function, double highest,
                                    std::span<const scene::MagnifiedRange> ranges) {
  std::vector<scene::Knot> knots;
  auto range = ranges.begin();
  double end = -std::numeric_limits<double>::infinity();  // of the last range
  const auto begin_range = [&] {
    if (range->low > end) knots.push_back(at(below(function, range->low), range->low));
    end = range->high;
    if (++range == ranges.end() || range->low > end) knots.push_back(at(function.evaluate(end), end));
  };
  for (const scene::Knot& knot : function.knots()) {
    while (range != ranges.end() && range->low <= knot.value) begin_range();
    if (knot.value > end && knot.value <= highest) knots.push_back(knot);
  }
  while (range != ranges.end()) begin_range();
  if (highest > knots.back().value) knots.push_back(at(function.evaluate(highest), highest));
  for (const scene::MagnifiedRange& r : ranges) {
    knots.push_back(at(function.evaluate(r.low), r.place));
    for (const scene::Knot& knot : function.knots())
      if (r.low < knot.value && knot.value < r.high) knots.push_back(at(knot, r.moved(knot.value)));
    knots.push_back(at(below(function, r.high), r.moved(r.high)));
  }
  return scene::TransferFunction(std::move(knots));
}

}  // namespace

void ScalarLattice::place(double origin, double new_reach) {
  constexpr double margin = 1.001;  // keeps rounding and the planes' error inside the lattice
  lattice.scalar_origin = origin;
  lattice.scalar_unit = scene::Lattice::unit_for(margin * new_reach);
  reach = new_reach;
}

bool ScalarLattice::resolves(const FunctionPiece& piece, double most_error) const {
  const auto on_lanes = [&](double v) { return static_cast<float>(lattice.scalar_step(v)); };
  if (on_lanes(piece.low) == on_lanes(piece.high)) return false;
  const double reached =
      std::max(std::abs(piece.low - lattice.scalar_origin), std::abs(piece.high - lattice.scalar_origin));
  // Just below a step, the error is a whole last place, because a value that would round to the step becomes the next
  // float below the step.
  const double error = std::max(plane_error * lattice.scalar_unit,
                                std::min(reached, reach) * (piece.step_above ? 2 * float_error : float_error));
  return !(piece.change * error > most_error * (piece.high - piece.low));
}

std::optional<FrameLattice> magnify(ScalarLattice scalars, const std::array<double, 2>& range,
                                    std::span<const FunctionPiece> pieces, double most_error,
                                    const scene::TransferFunction& function) {
  const auto [low, high] = range;
  const double length = high - low;
  if (!(length > 0)) return std::nullopt;
  for (std::size_t count = 1; count <= most_ranges;) {
    const double total = length + static_cast<double>(count) * (1 + gap) * length;
    if (!std::isfinite(low + total)) return std::nullopt;
    scalars.place(low + total / 2, total / 2);
    const std::optional<std::vector<Range>> ranges = steep_ranges(scalars, low, high, pieces, most_error);
    if (!ranges || ranges->empty()) return std::nullopt;
    if (ranges->size() > count) {
      count = ranges->size();
      continue;
    }
    FrameLattice result{scalars.lattice, {}, {}};
    double place = high;
    for (const Range& r : *ranges) {
      place += gap * length;
      result.magnified.push_back({r.low, r.high, place, length / (r.high - r.low)});
      place += length;
    }
    result.function = moved_knots(function, std::max(high, ranges->back().high), result.magnified);
    return result;
  }
  return std::nullopt;
}

}  // namespace tessera::frame
