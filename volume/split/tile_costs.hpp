// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/pixel_rect.hpp"

namespace tessera::volume {

/// What a tile of rays took of a thread, or the part of a tile that lies in a region of the picture.
struct TileTime {
  scene::PixelRect pixels;
  float microseconds;
};

/// What the pixels of a picture take, as pictures before it have taught, carried from view to view.
///
/// The picture is a lattice of squares of `side` pixels. A new view has each square's rays cost what the old view's
/// rays cost that met them on the plane through the volume's middle across the new view: a pixel near or far costs what
/// a ray does, so nothing is scaled. Then what a tile took is shared out between its squares as they were thought to
/// cost before, which tells them apart better than one time a tile could, as the view moves on.
///
/// Whoever has a part of a tile reads all the voxels that the tile meets: a share of the tile's cost is each part's.
class TileCosts {
 public:
  static constexpr int side = 8;

  /// Nothing is known yet: all alike. A valid camera and size; `middle` of the volume, world.
  TileCosts(const scene::Camera& camera, scene::ImageSize size, const glm::dvec3& middle);

  /// To another view of a picture of this size.
  void turn_to(const scene::Camera& camera);

  /// What this view's picture took. Every pixel is in one of `times`; those of none keep what they had.
  void learn(std::span<const TileTime> times);

  [[nodiscard]] const scene::Camera& camera() const { return camera_; }
  [[nodiscard]] scene::ImageSize size() const { return size_; }

  /// Nanoseconds of a rectangle of pixels, in one process. Not after turn_to() or learn() until sum() is called.
  [[nodiscard]] double of(const scene::PixelRect& rect) const;
  void sum();

 private:
  [[nodiscard]] float at(double x, double y) const;

  scene::Camera camera_;
  scene::ImageSize size_;
  glm::dvec3 middle_;
  int width_, height_;                   ///< squares
  std::vector<float> density_;           ///< nanoseconds a pixel, of a tile that one process has
  std::vector<double> squares_, tiles_;  ///< summed-area tables (Crow 1984), with a row and a column of zeros
};

}  // namespace tessera::volume
