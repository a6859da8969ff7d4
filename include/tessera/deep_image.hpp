// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tessera/camera.hpp"

namespace tessera {
inline namespace v0_1 {

/// A stretch of one pixel's ray with matter in it, as OpenEXR's deep images have it.
struct DeepImageSample {
  float z, z_back;         ///< planar depth along the view direction, world units
  float red, green, blue;  ///< linear, premultiplied: the light that leaves the stretch's front, nothing before it
  float alpha;             ///< 1 - transmittance of the stretch
};
static_assert(sizeof(DeepImageSample) == 24);

/// A picture that keeps depth: any number of samples in a pixel.
///
/// Shape  samples of pixel i (row-major, row 0 at the top) are samples[begin[i]] to samples[begin[i + 1] - 1].
/// Holds  tidy in OpenEXR's sense: z <= z_back <= z of the next, no two points (z = z_back) at one depth; all finite;
///        0 <= alpha <= 1, colours >= 0.
struct DeepImage {
  ImageSize size{0, 0};
  std::vector<std::uint64_t> begin;  ///< one a pixel, and the end
  std::vector<DeepImageSample> samples;

  [[nodiscard]] std::span<const DeepImageSample> pixel(std::size_t i) const {
    return std::span(samples).subspan(begin[i], begin[i + 1] - begin[i]);
  }
};

}  // namespace v0_1
}  // namespace tessera
