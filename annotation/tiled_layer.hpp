// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "tessera/camera.hpp"

namespace tessera::annotation {

/// A layer over an image. Since most of the layer is empty, tiles of pixels are allocated when they are first written.
class TiledLayer {
 public:
  static constexpr int side = 16;  ///< side of a tile, in pixels
  /// Row-major, premultiplied, in the image's own values.
  using Pixel = std::array<float, 4>;
  using Tile = std::array<Pixel, static_cast<std::size_t>(side) * side>;

  explicit TiledLayer(ImageSize size)
      : size_(size), columns_((size.width + side - 1) / side), rows_((size.height + side - 1) / side) {
    tiles_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  }

  [[nodiscard]] ImageSize size() const { return size_; }
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  /// Returns a tile; null if it has not been written.
  [[nodiscard]] const Tile* tile(int column, int row) const { return tiles_[index(column, row)].get(); }

  /// A pixel of the image, for writing.
  [[nodiscard]] Pixel& at(int x, int y) {
    std::unique_ptr<Tile>& tile = tiles_[index(x / side, y / side)];
    if (!tile) tile = std::make_unique<Tile>();  // a tile of zeros
    return (*tile)[static_cast<std::size_t>(y % side) * side + static_cast<std::size_t>(x % side)];
  }

  /// Composites `color` over the pixel.
  void blend(int x, int y, const glm::dvec3& color, double alpha) {
    Pixel& pixel = at(x, y);
    const auto a = static_cast<float>(alpha);
    for (int c = 0; c < 3; ++c)
      pixel[static_cast<std::size_t>(c)] =
          a * static_cast<float>(color[c]) + (1 - a) * pixel[static_cast<std::size_t>(c)];
    pixel[3] = a + (1 - a) * pixel[3];
  }

 private:
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }
  ImageSize size_;
  int columns_, rows_;
  std::vector<std::unique_ptr<Tile>> tiles_;
};

}  // namespace tessera::annotation
