// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/chart_measure.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "analysis/delta_e.hpp"

namespace tessera::analysis {

ChartError chart_error(const Image& image, std::span<const PixelIndex> pixels, std::span<const ReferencePixel> truths,
                       int channels) {
  ChartError error;
  std::vector<double> largest;
  largest.reserve(pixels.size());
  double squares = 0;
  std::size_t visible = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const float* const value = &image.rgba[4 * image.index(pixels[i].x, pixels[i].y)];
    const double truth[4] = {truths[i].r, truths[i].g, truths[i].b, truths[i].a};
    double most = 0;
    for (int c = 0; c < channels; ++c) {
      if (!std::isfinite(value[c])) {
        error.finite = false;
        most = std::numeric_limits<double>::infinity();
        continue;
      }
      const double difference = std::abs(value[c] - truth[c]);
      most = std::max(most, difference);
      squares += difference * difference;
    }
    largest.push_back(most);
    // Encoding to sRGB and decoding cancel each other; only the clamp of the display remains.
    const auto seen = [](double r, double g, double b) {
      return lab_of_linear(glm::clamp(glm::dvec3(r, g, b), 0.0, 1.0));
    };
    if (!std::isfinite(most) ||
        delta_e_2000(seen(value[0], value[1], value[2]), seen(truth[0], truth[1], truth[2])) > 1)
      ++visible;
  }
  if (largest.empty()) return error;
  const double count = static_cast<double>(largest.size());
  error.rms = std::sqrt(squares / (count * channels));
  error.visible_share = static_cast<double>(visible) / count;
  std::sort(largest.begin(), largest.end());
  error.max = largest.back();
  error.p999 = largest[static_cast<std::size_t>(std::ceil(0.999 * count)) - 1];
  return error;
}

double ChartPoint::median_ms() const {
  std::vector<double> times = frame_ms;
  std::sort(times.begin(), times.end());
  const std::size_t n = times.size();
  return n % 2 == 1 ? times[n / 2] : 0.5 * (times[n / 2 - 1] + times[n / 2]);
}
double ChartPoint::min_ms() const { return *std::min_element(frame_ms.begin(), frame_ms.end()); }
double ChartPoint::max_ms() const { return *std::max_element(frame_ms.begin(), frame_ms.end()); }

void mark_front(std::vector<ChartPoint>& points) {
  for (ChartPoint& p : points) {
    p.on_front = p.measured() && std::none_of(points.begin(), points.end(), [&](const ChartPoint& q) {
                   if (!q.measured() || &q == &p) return false;
                   const double time = q.median_ms() - p.median_ms(), error = q.error.max - p.error.max;
                   return time <= 0 && error <= 0 && (time < 0 || error < 0);
                 });
  }
}

const ChartPoint* fastest_within(std::span<const ChartPoint> points, double bound) {
  const ChartPoint* best = nullptr;
  for (const ChartPoint& p : points)
    if (p.measured() && p.error.max <= bound && (best == nullptr || p.median_ms() < best->median_ms())) best = &p;
  return best;
}

}  // namespace tessera::analysis
