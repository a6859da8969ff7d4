// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tessera/camera.hpp"

namespace tessera {
inline namespace v0_1 {

/// A sample of OpenEXR's deep images: an interval of a pixel's ray that absorbs or emits light.
struct DeepImageSample {
  float z, z_back;         ///< planar depth along the view direction, world units
  float red, green, blue;  ///< linear, premultiplied: the interval's light without attenuation by anything in front of
                           ///< it
  float alpha;             ///< 1 - transmittance of the interval
};
static_assert(sizeof(DeepImageSample) == 24);

/// An image with depth: each pixel has any number of samples.
///
/// Shape  The samples of pixel i (row-major, row 0 at the top) are samples[begin[i]] to samples[begin[i + 1] - 1].
/// Holds  The samples of a pixel are tidy as OpenEXR defines it: z <= z_back <= z of the next sample, and no two point
///        samples (z = z_back) have the same depth. All numbers are finite, 0 <= alpha <= 1, and colours are >= 0.
struct DeepImage {
  ImageSize size{0, 0};
  std::vector<std::uint64_t> begin;  ///< index of each pixel's first sample; then the number of samples
  std::vector<DeepImageSample> samples;

  [[nodiscard]] std::span<const DeepImageSample> pixel(std::size_t i) const {
    return std::span(samples).subspan(begin[i], begin[i + 1] - begin[i]);
  }
};

}  // namespace v0_1
}  // namespace tessera
