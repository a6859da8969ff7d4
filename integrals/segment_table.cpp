// SPDX-License-Identifier: BSD-3-Clause
#include "integrals/segment_table.hpp"

#include <algorithm>
#include <cmath>

#include "integrals/segment_integrator.hpp"

namespace tessera::integrals {
namespace {

SegmentTable::Constant constant_of(const scene::Knot& knot) {
  return {knot.extinction, knot.color.x, knot.color.y, knot.color.z};
}

constexpr double thin = 1e-6;   // optical depth that represents 0
constexpr double opaque = 1e6;  // optical depth that represents infinity

}  // namespace

SegmentTable::SegmentTable(const scene::TransferFunction& function, scene::Emission emission, int table_size)
    : size(table_size),
      depths(table_size / 4 + 1),
      low(function.knots().front().value),
      high(function.knots().back().value),
      scale(high > low ? (size - 1) / (high - low) : 0),
      below(constant_of(function.knots().front())),
      above(constant_of(function.knots().back())) {
  const auto n = static_cast<std::size_t>(size), m = static_cast<std::size_t>(depths);
  mean_extinction.assign(n * n, 0);
  light.assign(n * n * m * 4, 0);
  if (scale == 0) return;
  const PiecewiseTable pieces(function);
  const auto scalar = [&](std::size_t i) {
    return i + 1 == n ? high : low + (high - low) * (static_cast<double>(i) / static_cast<double>(n - 1));
  };
  const double most = function.max_extinction();
  SegmentBatch batch;
  batch.reserve(n * m);
  std::vector<double> mean(n);
  for (std::size_t front = 0; front < n; ++front) {
    batch.size = n;
    // Uses a thin segment, because the integrator stops where the transmittance is low.
    const double length = most > 0 ? thin / most : 1;
    for (std::size_t back = 0; back < n; ++back)
      batch.length[back] = length, batch.scalar_front[back] = scalar(front), batch.scalar_back[back] = scalar(back);
    integrate_exact(pieces, emission, batch);
    for (std::size_t back = 0; back < n; ++back) {
      mean[back] = batch.optical_depth[back] / length;
      mean_extinction[front * n + back] = static_cast<float>(mean[back]);
    }
    batch.size = n * m;
    for (std::size_t back = 0; back < n; ++back)
      for (std::size_t k = 0; k < m; ++k) {
        const double w = static_cast<double>(k) / static_cast<double>(m - 1);
        const double depth = std::clamp(2 * w / (1 - w), thin, opaque);
        const std::size_t i = back * m + k;
        batch.length[i] = mean[back] > 0 ? depth / mean[back] : 1;
        batch.scalar_front[i] = scalar(front), batch.scalar_back[i] = scalar(back);
      }
    integrate_exact(pieces, emission, batch);
    for (std::size_t i = 0; i < batch.size; ++i) {
      const double extinction = mean[i / m];
      const double factor = extinction > 0 ? -extinction / std::expm1(-extinction * batch.length[i]) : 1;
      float* const entry = &light[4 * (front * batch.size + i)];
      entry[0] = static_cast<float>(factor * batch.red[i]);
      entry[1] = static_cast<float>(factor * batch.green[i]);
      entry[2] = static_cast<float>(factor * batch.blue[i]);
    }
  }
}

}  // namespace tessera::integrals
