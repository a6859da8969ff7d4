// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tessera/image.hpp"
#include "tessera/reference.hpp"

/// Error and time of a method, and the Pareto front of methods.
namespace tessera::analysis {

/// Error of an image relative to the reference, over the compared pixels.
struct ChartError {
  double max = 0;            ///< largest absolute difference in linear premultiplied RGBA
  double rms = 0;            ///< root mean square over pixels and channels
  double p999 = 0;           ///< the 99.9 % quantile of the pixels' largest differences
  double visible_share = 0;  ///< share of pixels that differ by a Delta E 2000 above 1. Both images are composited over
                             ///< black, encoded to sRGB and clamped
  bool finite = true;        ///< the image contains no NaN or infinity; otherwise `max` is infinite
};

/// Computes the error of an image. `truths` are the reference values of `pixels`, in the same order. `channels` is 4,
/// or 3 for an image without opacity.
ChartError chart_error(const Image& image, std::span<const PixelIndex> pixels, std::span<const ReferencePixel> truths,
                       int channels = 4);

struct ChartPoint {
  std::string family, name;      ///< "planes, sampled"; "planes sampled:4"
  std::string options;           ///< options of `tessera render` for this image
  std::vector<double> frame_ms;  ///< times of all repetitions
  double prepare_ms = 0;         ///< time of the preparation that depends only on data and transfer function
  ChartError error;
  bool on_front = false;  ///< no other method is both faster and more accurate
  std::string left_out;   ///< reason why the method was not measured; empty if it was

  [[nodiscard]] bool measured() const { return left_out.empty() && !frame_ms.empty(); }
  [[nodiscard]] double median_ms() const;
  [[nodiscard]] double min_ms() const;
  [[nodiscard]] double max_ms() const;
};

/// Sets `on_front` of all points, by median time and largest error.
void mark_front(std::vector<ChartPoint>& points);

/// Returns the fastest point whose largest error is at most `bound`; null if there is none.
const ChartPoint* fastest_within(std::span<const ChartPoint> points, double bound);

}  // namespace tessera::analysis
