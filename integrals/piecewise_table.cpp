// SPDX-License-Identifier: BSD-3-Clause
#include "integrals/piecewise_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace tessera::integrals {
namespace {

double channel_of(const scene::Knot& knot, std::size_t channel) {
  return channel == 0 ? knot.extinction : knot.color[static_cast<int>(channel) - 1];
}

}  // namespace

PiecewiseTable::PiecewiseTable(const scene::TransferFunction& function) : knot_count(function.knots().size()) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto knots = function.knots();
  values.assign(std::bit_ceil(knot_count + 1) - 1, infinity);
  for (std::size_t i = 0; i < knot_count; ++i) values[i] = knots[i].value;
  for (std::size_t i = 0; i <= knot_count; ++i) {
    const scene::Knot& low = knots[i == 0 ? 0 : i - 1];
    const scene::Knot& high = knots[i == knot_count ? i - 1 : i];
    below.push_back(i == 0 ? -infinity : low.value);
    above.push_back(i == knot_count ? infinity : high.value);
    base.push_back(low.value);
    const double width = high.value - low.value;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const double start = channel_of(low, c), slope = (channel_of(high, c) - start) / width;
      channels[c].start.push_back(start);
      channels[c].slope.push_back(width > 0 && std::isfinite(slope) ? slope : 0);
    }
  }
  // Lanes load whole vectors even if the table is short.
  const std::size_t padded = std::max<std::size_t>(knot_count + 1, 8);
  for (auto* column : {&below, &above, &base}) column->resize(padded, 0);
  for (Channel& channel : channels) channel.start.resize(padded, 0), channel.slope.resize(padded, 0);
}

}  // namespace tessera::integrals
