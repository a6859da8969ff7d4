// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/peel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/error.hpp"

namespace tessera::frame {

void check_peel(const Peel& peel, scene::ImageSize size, std::uint64_t memory_bytes) {
  const auto pixels = static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height);
  const std::uint64_t bytes = pixels * 5 * sizeof(float) * static_cast<std::uint64_t>(peel.layers);
  if (bytes > memory_bytes / 2)
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("`peel`: {} layers of {}x{} pixels take {} MiB, more than half of `memory`; raise "
                                   "`memory`, or request fewer layers",
                                   peel.layers, size.width, size.height, bytes >> 20));
}

std::vector<scene::Image> layer_images(const scene::DeepImage& layers, int count) {
  std::vector<scene::Image> images;
  images.reserve(static_cast<std::size_t>(count));
  for (int n = 0; n < count; ++n) images.emplace_back(layers.size);
  for (std::size_t p = 0; p + 1 < layers.begin.size(); ++p) {
    const auto pixel = layers.pixel(p);
    for (std::size_t n = 0; n < std::min(pixel.size(), images.size()); ++n) {
      const scene::DeepImageSample& s = pixel[n];
      float* const rgba = &images[n].rgba[4 * p];
      rgba[0] = s.red, rgba[1] = s.green, rgba[2] = s.blue, rgba[3] = s.alpha;
      images[n].depth[p] = s.z;
    }
  }
  return images;
}

void make_tidy(scene::DeepImage& layers) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (std::size_t p = 0; p + 1 < layers.begin.size(); ++p) {
    float last = -infinity;
    bool point = false;  // the sample at `last` is a point
    for (std::uint64_t n = layers.begin[p]; n < layers.begin[p + 1]; ++n) {
      scene::DeepImageSample& s = layers.samples[n];
      s.z = std::max(s.z, last), s.z_back = std::max(s.z_back, s.z);
      if (point && s.z_back == last) s.z = s.z_back = std::nextafter(last, infinity);
      last = s.z_back, point = s.z == s.z_back;
    }
  }
}

void put_deep(scene::DeepImage&& made, const FrameSettings& settings, RenderedFrame& frame) {
  if (settings.peel) {
    frame.peel = settings.peel;
    frame.layers = layer_images(made, settings.peel->layers);
    if (settings.deep) make_tidy(made);
  }
  frame.statistics.mesh.deep_samples = settings.deep ? made.samples.size() : 0;
  if (settings.deep) frame.deep = std::move(made);
}

}  // namespace tessera::frame
