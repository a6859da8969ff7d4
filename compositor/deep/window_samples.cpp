// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/deep/window_samples.hpp"

#include "scene/error_budget.hpp"

namespace tessera::compositor {

WindowSamples::WindowSamples(double accuracy)
    : pieces(static_cast<float>(scene::error_budget::deep_pieces(accuracy))),
      merging(static_cast<float>(scene::error_budget::deep_merging(accuracy))),
      alpha_rounding(static_cast<float>(scene::error_budget::deep_alpha(accuracy) * 0x1p24)) {}

void WindowSamples::start() {
  ended.clear();
  begun.fill(0);
  for (auto* steps : {&front, &back}) steps->fill(0);
  // Any finite numbers: lanes compute with them, but use nothing of a pixel without a sample.
  for (auto* sums : {&red, &green, &blue, &alpha, &optical_depth}) sums->fill(0);
  for (auto* numbers :
       {&last_alpha, &light_error, &transmittance_error, &most_ratio, &most_depth, &slope_low, &slope_high})
    numbers->fill(0);
  for (std::size_t c = 0; c < 3; ++c) light_low[c].fill(0), light_high[c].fill(0);
}

void WindowSamples::end_all() {
  for (std::uint32_t p = 0; p < pixels; ++p) {
    const auto sum = [&](const PerPixel<double>& of) { return static_cast<float>(of[p]); };
    if (begun[p] != 0) ended.push_back({p, front[p], back[p], sum(red), sum(green), sum(blue), sum(alpha)});
    begun[p] = 0;
  }
}

}  // namespace tessera::compositor
