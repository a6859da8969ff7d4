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

/// Error and time of one method, and which methods no other one beats.
namespace tessera::analysis {

/// Of a picture against the reference, over the pixels that were looked at.
struct ChartError {
  double max = 0;            ///< largest absolute difference in linear premultiplied RGBA
  double rms = 0;            ///< over pixels and channels
  double p999 = 0;           ///< the 99.9 % quantile of the pixels' largest differences
  double visible_share = 0;  ///< of pixels that differ by Delta E 2000 above 1, over black, encoded to sRGB and clamped
  bool finite = true;        ///< no NaN or infinity; else `max` is infinite
};

/// `truths` in the order of `pixels`. `channels` 4, or 3 for a picture without opacity.
ChartError chart_error(const Image& image, std::span<const PixelIndex> pixels, std::span<const ReferencePixel> truths,
                       int channels = 4);

struct ChartPoint {
  std::string family, name;      ///< "planes, sampled"; "planes sampled:4"
  std::string options;           ///< of `tessera render`, that make this picture
  std::vector<double> frame_ms;  ///< one a repetition
  double prepare_ms = 0;         ///< before the first: what depends on data and transfer function alone
  ChartError error;
  bool on_front = false;  ///< no other is both faster and nearer
  std::string left_out;   ///< why there are no figures; empty: there are

  [[nodiscard]] bool measured() const { return left_out.empty() && !frame_ms.empty(); }
  [[nodiscard]] double median_ms() const;
  [[nodiscard]] double min_ms() const;
  [[nodiscard]] double max_ms() const;
};

/// Sets `on_front`: by median time and largest error.
void mark_front(std::vector<ChartPoint>& points);

/// The fastest point whose largest error is at most `bound`; null if there is none.
const ChartPoint* fastest_within(std::span<const ChartPoint> points, double bound);

}  // namespace tessera::analysis
