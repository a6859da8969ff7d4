// SPDX-License-Identifier: BSD-3-Clause
#include "server/level_choice.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::server {
namespace {

/// The assumed part of a frame's time that does not depend on the number of pixels. It is a compromise between meshes
/// whose cells cover many pixels and meshes whose cells cover none.
constexpr double part_of_data = 0.3;
/// The size only grows if the estimated time is below this fraction of the budget, so that the size does not oscillate.
constexpr double room = 0.85;

double pixels(std::size_t shrink) { return 1 / (shrinks.at(shrink) * shrinks.at(shrink)); }

}  // namespace

ImageSize shrunk(ImageSize size, double shrink) {
  const auto side = [shrink](int pixels) { return std::max(1, static_cast<int>(std::lround(pixels / shrink))); };
  return {side(size.width), side(size.height)};
}

std::size_t LevelChoice::fitting(std::size_t from, double ms) const {
  for (std::size_t to = from; to < shrinks.size(); ++to)
    if (ms * (part_of_data + (1 - part_of_data) * pixels(to) / pixels(from)) <= budget_ms_) return to;
  return shrinks.size();
}

void LevelChoice::took(std::size_t shrink, bool preview, double ms) {
  if (preview != preview_) return;  // the time was measured before the data or the preview changed
  measured_ = true;
  if (ms > budget_ms_) {
    const std::size_t to = fitting(shrink, ms);
    at_ = std::max(at_, std::min(to, shrinks.size() - 1));
    if (shrink + 1 == shrinks.size() && !preview_) {
      preview_ = true;
      at_ = 1;
    }
  } else if (shrink == at_ && at_ > 0 && ms * pixels(at_ - 1) / pixels(at_) <= room * budget_ms_) {
    --at_;
  }
}

void LevelChoice::full_took(double ms) {
  const std::size_t to = fitting(0, ms);
  if (preview_ && to < shrinks.size()) {
    preview_ = false;
    at_ = to;
  } else if (!preview_ && !measured_) {
    at_ = std::min(to, shrinks.size() - 1);
  }
}

}  // namespace tessera::server
