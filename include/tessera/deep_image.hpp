// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tessera/camera.hpp"

namespace tessera {
inline namespace v0_1 {

/// An interval of one pixel's ray that contains matter, as in OpenEXR's deep images.
struct DeepImageSample {
  float z, z_back;         ///< planar depth along the view direction, world units
  float red, green, blue;  ///< linear, premultiplied: light that leaves the interval's front, with nothing before it
  float alpha;             ///< 1 - transmittance of the interval
};
static_assert(sizeof(DeepImageSample) == 24);

/// An image that keeps depth: any number of samples per pixel.
///
/// Shape  samples of pixel i (row-major, row 0 at the top) are samples[begin[i]] to samples[begin[i + 1] - 1].
/// Holds  tidy in OpenEXR's sense: z <= z_back <= z of the next, no two points (z = z_back) at one depth; all finite;
///        0 <= alpha <= 1, colours >= 0.
struct DeepImage {
  ImageSize size{0, 0};
  std::vector<std::uint64_t> begin;  ///< one per pixel, and the end
  std::vector<DeepImageSample> samples;

  [[nodiscard]] std::span<const DeepImageSample> pixel(std::size_t i) const {
    return std::span(samples).subspan(begin[i], begin[i + 1] - begin[i]);
  }
};

}  // namespace v0_1
}  // namespace tessera
