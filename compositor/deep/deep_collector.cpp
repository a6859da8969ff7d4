// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/deep/deep_collector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scene/error.hpp"

namespace tessera::compositor {

void DeepCollector::add(const scene::PixelRect& rect, std::vector<std::uint32_t> counts,
                        std::vector<scene::DeepImageSample> samples) {
  if (samples.empty()) return;
  const std::lock_guard lock(mutex_);
  // Samples count twice, because image() copies them to sort them.
  bytes_ += 2 * samples.size() * sizeof(scene::DeepImageSample) + counts.size() * sizeof(std::uint32_t);
  if (bytes_ > most_bytes_)
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("deep image, or layers of `peel`: samples take more than {} MiB; raise `memory` or "
                                   "`deep_accuracy`, or request fewer layers",
                                   most_bytes_ >> 20));
  blocks_.push_back({rect, std::move(counts), std::move(samples)});
}

scene::DeepImage DeepCollector::image() {
  const std::lock_guard lock(mutex_);
  scene::DeepImage image;
  image.size = size_;
  const auto width = static_cast<std::size_t>(size_.width), height = static_cast<std::size_t>(size_.height);
  image.begin.assign(width * height + 1, 0);
  const auto visit = [&](const Block& block, const auto& action) {
    std::size_t i = 0;
    for (int y = block.rect.y0; y < block.rect.y1; ++y)
      for (int x = block.rect.x0; x < block.rect.x1; ++x, ++i)
        action(static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x), block.counts[i]);
  };
  for (const Block& block : blocks_)
    visit(block, [&](std::size_t pixel, std::uint32_t count) { image.begin[pixel + 1] = count; });
  for (std::size_t i = 0; i < width * height; ++i) image.begin[i + 1] += image.begin[i];
  image.samples.resize(image.begin.back());
  for (Block& block : blocks_) {
    const scene::DeepImageSample* next = block.samples.data();
    visit(block, [&](std::size_t pixel, std::uint32_t count) {
      std::copy(next, next + count, image.samples.begin() + static_cast<std::ptrdiff_t>(image.begin[pixel]));
      next += count;
    });
    block = {};
  }
  blocks_.clear();
  bytes_ = 0;
  return image;
}

}  // namespace tessera::compositor
