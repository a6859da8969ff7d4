// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "projection/footprint.hpp"
#include "scene/deep_image.hpp"

namespace tessera::compositor {

/// Receives deep samples, rectangle by rectangle.
class DeepTarget {
 public:
  virtual ~DeepTarget() = default;
  /// Adds the samples of a rectangle, pixel by pixel in rows; `counts` has the number of samples of each pixel.
  /// Rectangles must be disjoint.
  virtual void add(const scene::PixelRect& rect, std::vector<std::uint32_t> counts,
                   std::vector<scene::DeepImageSample> samples) = 0;
};

/// Collects the deep samples of an image, with rectangles in any order and from any thread.
class DeepCollector final : public DeepTarget {
 public:
  /// `most_bytes` is an upper bound of the memory of the samples, including the copy that image() makes.
  DeepCollector(scene::ImageSize size, std::uint64_t most_bytes) : size_(size), most_bytes_(most_bytes) {}

  /// Throws Error(system_failure) if the samples exceed `most_bytes`.
  void add(const scene::PixelRect& rect, std::vector<std::uint32_t> counts,
           std::vector<scene::DeepImageSample> samples) override;

  /// Returns the image and empties the collector. Pixels for which no samples were added have none.
  scene::DeepImage image();

  /// Memory per pixel that is needed in addition to the samples.
  static constexpr std::uint64_t bytes_a_pixel = 2 * sizeof(std::uint64_t);

 private:
  struct Block {
    scene::PixelRect rect;
    std::vector<std::uint32_t> counts;
    std::vector<scene::DeepImageSample> samples;
  };
  scene::ImageSize size_;
  std::uint64_t most_bytes_, bytes_ = 0;
  std::mutex mutex_;
  std::vector<Block> blocks_;
};

}  // namespace tessera::compositor
