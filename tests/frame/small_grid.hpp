// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "scene/sample_source.hpp"

namespace tessera::frame {

/// Samples of a function of position at n^3 points of the box from -1 to 1.
inline std::unique_ptr<scene::MemorySource> small_grid(std::int64_t n,
                                                       const std::function<double(const glm::dvec3&)>& value) {
  scene::Grid grid;
  grid.geometry.points = {n, n, n};
  grid.geometry.origin = glm::dvec3(-1);
  grid.geometry.spacing = glm::dvec3(2.0 / static_cast<double>(n - 1));
  std::vector<float> values;
  for (std::int64_t k = 0; k < n; ++k)
    for (std::int64_t j = 0; j < n; ++j)
      for (std::int64_t i = 0; i < n; ++i)
        values.push_back(static_cast<float>(
            value(2.0 * glm::dvec3(double(i), double(j), double(k)) / static_cast<double>(n - 1) - 1.0)));
  return scene::MemorySource::of(grid, std::move(values));
}

}  // namespace tessera::frame
