// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <utility>
#include <vector>

#include "tessera/image.hpp"

namespace tessera::apps {

/// Images that are no longer needed and whose memory later images reuse. At most two are kept, to limit memory. May be
/// used from any thread.
class SpareImages {
 public:
  void keep(Image image) {
    const std::lock_guard lock(mutex_);
    if (images_.size() < most) images_.push_back(std::move(image));
  }
  /// Returns an image of this size, if there is one. Images of other sizes are dropped.
  Image take(ImageSize size) {
    const std::lock_guard lock(mutex_);
    images_.erase(
        std::remove_if(images_.begin(), images_.end(), [&](const Image& image) { return !fits(image, size); }),
        images_.end());
    if (images_.empty()) return {};
    Image taken = std::move(images_.back());
    images_.pop_back();
    return taken;
  }

 private:
  static bool fits(const Image& image, ImageSize size) {
    return image.size.width == size.width && image.size.height == size.height;
  }

  static constexpr std::size_t most = 2;
  std::mutex mutex_;
  std::vector<Image> images_;
};

}  // namespace tessera::apps
