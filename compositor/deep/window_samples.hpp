// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compositor/window_kernel.hpp"

namespace tessera::compositor {

/// The deep samples of the pixels of a square while windows of lattice segments are composited into them: the state of
/// a DeepMerger for each pixel. Depths are steps of the lattice; sums are in double precision, since a sample may
/// consist of many thousand pieces.
struct WindowSamples {
  static constexpr std::size_t pixels = WindowState::pixels;
  template <class T>
  using PerPixel = std::array<T, pixels>;

  explicit WindowSamples(double accuracy);

  /// A sample that has ended. Its light is not attenuated by what is in front of it.
  struct Sample {
    std::uint32_t pixel;
    std::int32_t front, back;
    float red, green, blue, alpha;
  };
  std::vector<Sample> ended;

  /// Starts all pixels without a sample.
  void start();
  /// Ends the samples of all pixels.
  void end_all();

  // Shares of the accuracy (scene/error_budget.hpp).
  float pieces, merging, alpha_rounding;

  alignas(64) PerPixel<std::int32_t> begun;  ///< -1: the pixel has a sample; 0: it has none
  // The sample, and the members of DeepMerger with the same names.
  alignas(64) PerPixel<std::int32_t> front, back;
  alignas(64) PerPixel<double> red, green, blue, alpha, optical_depth;
  alignas(64) PerPixel<float> last_alpha, light_error, transmittance_error, most_ratio, most_depth;
  alignas(64) PerPixel<float> slope_low, slope_high;
  alignas(64) std::array<PerPixel<float>, 3> light_low, light_high;
};

}  // namespace tessera::compositor
