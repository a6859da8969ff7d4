// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "tessera/camera.hpp"
#include "tessera/dataset.hpp"
#include "tessera/transfer_function.hpp"

namespace tessera::apps {

/// Tests views without rendering: the visible cells of this rank's part of a mesh, or the box of a grid.
class TrialCells {
 public:
  /// The data set must outlive this object. If `emits`, colour is visible without extinction.
  TrialCells(const Dataset& data, const TransferFunction& function, bool emits);

  /// Returns the number of pixels that certainly show something, because their centres are inside the outline of a
  /// cell. Counting stops at enough(). The cells are first scaled by `scale` along the axes.
  [[nodiscard]] std::uint64_t pixels(const Camera& camera, ImageSize size,
                                     const glm::dvec3& scale = glm::dvec3(1)) const;
  /// Whether a corner of a cell is in the image, or a cell, however thin, extends across the image.
  [[nodiscard]] bool is_in_view(const Camera& camera, ImageSize size) const;

  struct Cell {
    glm::dvec3 centre{0};
    double radius = 0;  ///< radius of a ball around the centre, inside the cell
  };
  /// The cell that contains the largest ball; radius 0 if there is no cell.
  [[nodiscard]] Cell largest() const;

  /// The number of visible pixels at which an image of this size is considered not to be empty.
  static std::uint64_t enough(ImageSize size) {
    return static_cast<std::uint64_t>(std::clamp<std::int64_t>(std::int64_t{size.width} * size.height / 256, 1, 64));
  }

 private:
  using Corners = std::array<glm::dvec3, 4>;
  template <class Use>
  void for_each(const Use& use) const;

  MeshArrays mesh_;
  std::vector<Corners> box_;
  const TransferFunction& function_;
  bool emits_;
};

}  // namespace tessera::apps
