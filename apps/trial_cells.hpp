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

/// What a view is tried on without rendering it: the cells of this rank's part of a mesh that a transfer function
/// shows, or the box of a grid.
class TrialCells {
 public:
  /// The data set has to outlive it. `emits`: colour shows without extinction.
  TrialCells(const Dataset& data, const TransferFunction& function, bool emits);

  /// How many pixels are sure to show something: their centres are inside of a cell's outline. Counted up to enough().
  /// The cells are stretched by `scale` along the axes first.
  [[nodiscard]] std::uint64_t pixels(const Camera& camera, ImageSize size,
                                     const glm::dvec3& scale = glm::dvec3(1)) const;
  /// Whether a corner of a cell is in the picture or a cell lies across it, however thin.
  [[nodiscard]] bool is_in_view(const Camera& camera, ImageSize size) const;

  struct Cell {
    glm::dvec3 centre{0};
    double radius = 0;  ///< of a ball round the centre that is inside of the cell
  };
  /// The cell that has room for the largest ball; radius 0 if there is no cell.
  [[nodiscard]] Cell largest() const;

  /// Pixels that are no accident, of a picture of this size.
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
