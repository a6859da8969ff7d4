// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/deep/lattice_deep_sink.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "compositor/deep/deep_sink.hpp"
#include "compositor/finite_float.hpp"
#include "compositor/picture_sink.hpp"

namespace tessera::compositor {

LatticeDeepSink::LatticeDeepSink(const TileScene& scene, const ImageWindow& window, double accuracy, DeepTarget& target)
    : lattice_(scene.lattice), window_(window), samples_(accuracy), pixels_(scene, samples_), target_(&target) {}

void LatticeDeepSink::start(const scene::PixelRect& rect) {
  rect_ = rect;
  segments_here_ = 0;
  samples_.start();
  pixels_.start(rect);
}

void LatticeDeepSink::take(Store& store, Depth final_depth, std::size_t at_least, scene::StageTimer& timer) {
  segments_here_ += pixels_.take(store, final_depth, at_least, timer);
}

void LatticeDeepSink::finish() {
  segments_ += segments_here_;
  write_pixels(pixels_, rect_, window_);
  samples_.end_all();
  // The samples of each pixel are in order.
  const auto n = static_cast<std::size_t>(rect_.area());
  std::vector<std::uint32_t> place(n + 1, 0), order(samples_.ended.size());
  for (const WindowSamples::Sample& s : samples_.ended) ++place[s.pixel + 1];
  for (std::size_t p = 0; p < n; ++p) place[p + 1] += place[p];
  std::vector<std::uint32_t> next(place.begin(), place.end() - 1), counts(n);
  for (std::uint32_t i = 0; i < order.size(); ++i) order[next[samples_.ended[i].pixel]++] = i;
  std::vector<scene::DeepImageSample> samples;
  samples.reserve(order.size());
  for (std::size_t p = 0; p < n; ++p) {
    const std::size_t first = samples.size();
    for (std::uint32_t k = place[p]; k < place[p + 1]; ++k) {
      const WindowSamples::Sample& s = samples_.ended[order[k]];
      double front = lattice_.depth(s.front);
      const double back = lattice_.depth(s.back);
      // The first sample begins where the image is visible, which is computed in double precision.
      constexpr double most_steps = 256;
      if (k == place[p]) {
        const double visible = pixels_.value(p).depth;
        if (std::abs(visible - front) <= most_steps * lattice_.depth_unit) front = std::min(visible, back);
      }
      append_tidy({finite_float(front), finite_float(back), s.red, s.green, s.blue, std::min(s.alpha, 1.0f)}, first,
                  samples);
    }
    counts[p] = static_cast<std::uint32_t>(samples.size() - first);
  }
  target_->add(rect_, std::move(counts), std::move(samples));
}

}  // namespace tessera::compositor
