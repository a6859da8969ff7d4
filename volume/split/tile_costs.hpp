// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/pixel_rect.hpp"

namespace tessera::volume {

/// The time that a thread took for the rays of a tile, or for the part of a tile that is in a region of the image.
struct TileTime {
  scene::PixelRect pixels;
  float microseconds;
};

/// The cost of the pixels of an image, learned from earlier images and carried from view to view.
///
/// The image is divided into squares of `side` pixels. In a new view, the rays of a square are assumed to cost as much
/// as the old view's rays through the same points of a plane; this plane contains the volume's middle and is parallel
/// to the new image plane. The cost of a ray does not depend on the distance of the eye, so costs are not scaled. The
/// time of a tile is then distributed over its squares in proportion to their previous costs. As the view changes, this
/// resolves the squares better than the tile's time alone.
///
/// A process that has a part of a tile reads all voxels that the tile meets, so every part bears a share of the tile's
/// cost.
class TileCosts {
 public:
  static constexpr int side = 8;

  /// Starts with equal costs. Camera and size must be valid; `middle` is the middle of the volume in world space.
  TileCosts(const scene::Camera& camera, scene::ImageSize size, const glm::dvec3& middle);

  /// Changes to another view with the same image size.
  void turn_to(const scene::Camera& camera);

  /// Learns the times of this view's image. Every pixel is in at most one element of `times`; pixels in no element keep
  /// their cost.
  void learn(std::span<const TileTime> times);

  [[nodiscard]] const scene::Camera& camera() const { return camera_; }
  [[nodiscard]] scene::ImageSize size() const { return size_; }

  /// Time that a rectangle of pixels takes in one process, in nanoseconds. sum() must have been called after turn_to()
  /// or learn().
  [[nodiscard]] double of(const scene::PixelRect& rect) const;
  void sum();

 private:
  [[nodiscard]] float at(double x, double y) const;

  scene::Camera camera_;
  scene::ImageSize size_;
  glm::dvec3 middle_;
  int width_, height_;                   ///< in squares
  std::vector<float> density_;           ///< nanoseconds per pixel, for a tile that a single process renders
  std::vector<double> squares_, tiles_;  ///< summed-area tables (Crow 1984), with a row and a column of zeros
};

}  // namespace tessera::volume
