// SPDX-License-Identifier: BSD-3-Clause
#include "colormaps/pilot_pixels.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::colormaps {
namespace {

constexpr double saturated_alpha = 0.97, most_saturated = 0.005, least_alpha = 1.0 / 255;
constexpr double small_part = 0.15, small_part_factor = 0.6, least_face = 0.3;

double interpolated(std::span<const std::array<double, 2>> points, double value) {
  const auto above = std::ranges::upper_bound(points, value, {}, [](const auto& p) { return p[0]; });
  if (above == points.begin()) return points.front()[1];
  if (above == points.end()) return points.back()[1];
  const auto& a = *(above - 1);
  return std::lerp(a[1], (*above)[1], (value - a[0]) / ((*above)[0] - a[0]));
}

}  // namespace

PilotPixels::PilotPixels(const scene::FieldSamples& samples, std::span<const std::array<double, 2>> extinctions,
                         double unit) {
  if (samples.samples.empty()) return;
  const int side = samples.samples.size() > 30000 ? 24 : 16;
  const auto pixels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  const glm::dvec3& side_length = samples.sides;
  const std::array<double, 3> face{side_length.y * side_length.z, side_length.z * side_length.x,
                                   side_length.x * side_length.y};
  const double largest_face = *std::ranges::max_element(face);
  std::array<std::size_t, 3> first{};  // for each axis, the first pixel of its image
  std::size_t pictures = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (face[axis] > 0 && face[axis] >= least_face * largest_face) first[axis] = pictures++ * pixels;
  depths_.assign(pictures * pixels, 0.0);
  // Each sample is distributed over the nearest pixels, because otherwise rows of samples would leave stripes.
  struct Place {
    int pixel[2];
    double share[2];
  };
  const auto place = [&](float x) {
    const double at = static_cast<double>(x) * side - 0.5, below = std::floor(at);
    const int pixel = static_cast<int>(below);
    return Place{{std::clamp(pixel, 0, side - 1), std::clamp(pixel + 1, 0, side - 1)}, {1 - (at - below), at - below}};
  };
  for (const scene::FieldSample& s : samples.samples) {
    const double absorbed = interpolated(extinctions, s.value) * unit * samples.longest * static_cast<double>(s.volume);
    if (absorbed == 0) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
      if (!(face[axis] > 0) || face[axis] < least_face * largest_face) continue;
      const double depth = absorbed * static_cast<double>(pixels) / face[axis];
      const Place u = place(s.at[a]), v = place(s.at[b]);
      for (const int k : {0, 1})
        for (const int l : {0, 1})
          depths_[first[axis] + static_cast<std::size_t>(u.pixel[k] + side * v.pixel[l])] +=
              depth * u.share[k] * v.share[l];
    }
  }
}

double PilotPixels::scale(double mean_alpha) const {
  const auto too_much = [&](double factor) {
    double sum = 0;
    std::size_t shown = 0, saturated = 0;
    for (const double depth : depths_) {
      const double alpha = -std::expm1(-depth * factor);
      if (alpha < least_alpha) continue;
      sum += alpha;
      ++shown;
      saturated += alpha > saturated_alpha ? 1 : 0;
    }
    const auto count = static_cast<double>(shown);
    const bool small = count < small_part * static_cast<double>(depths_.size());
    return sum > mean_alpha * (small ? small_part_factor : 1) * count ||
           static_cast<double>(saturated) > most_saturated * count;
  };
  const double deepest = depths_.empty() ? 0 : *std::ranges::max_element(depths_);
  if (!(deepest > 0) || !std::isfinite(deepest)) return 1;
  double low = std::log(1e-3 / deepest), high = std::log(1e6 / deepest);
  for (int i = 0; i < 48; ++i) {
    const double middle = (low + high) / 2;
    (too_much(std::exp(middle)) ? high : low) = middle;
  }
  return std::exp(low);
}

}  // namespace tessera::colormaps
