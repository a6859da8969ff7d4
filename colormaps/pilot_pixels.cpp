#include "colormaps/pilot_pixels.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::colormaps {
namespace {

constexpr double saturated_alpha = 0.98, least_alpha = 1.0 / 255;

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
  depths_.assign(3 * pixels, 0.0);
  const auto place = [&](float x) { return std::min(static_cast<int>(static_cast<double>(x) * side), side - 1); };
  for (const scene::FieldSample& s : samples.samples) {
    const double absorbed = interpolated(extinctions, s.value) * unit * samples.longest * static_cast<double>(s.volume);
    if (absorbed == 0) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
      const double area = samples.sides[static_cast<int>(a)] * samples.sides[static_cast<int>(b)];
      if (!(area > 0)) continue;  // of a flat box: seen along its plane
      const int pixel = place(s.at[a]) + side * place(s.at[b]);
      depths_[axis * pixels + static_cast<std::size_t>(pixel)] += absorbed * static_cast<double>(pixels) / area;
    }
  }
}

double PilotPixels::scale(double mean_alpha, double most_saturated) const {
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
    return sum > mean_alpha * count || static_cast<double>(saturated) > most_saturated * count;
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
