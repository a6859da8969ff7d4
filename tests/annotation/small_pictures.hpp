// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec2.hpp>
#include <random>

#include "annotation/screen.hpp"
#include "tessera/annotation.hpp"

namespace tessera::annotation {

inline Camera orthographic(const glm::dvec3& position, const glm::dvec3& focal_point, double scale) {
  Camera camera;
  camera.position = position, camera.focal_point = focal_point, camera.parallel_scale = scale;
  return camera;
}

inline Camera perspective(const glm::dvec3& position, const glm::dvec3& focal_point, double angle) {
  Camera camera;
  camera.position = position, camera.focal_point = focal_point, camera.view_angle = angle;
  camera.projection = ProjectionKind::perspective;
  return camera;
}

/// An image without data.
inline Image empty_picture(ImageSize size) { return Image(size); }

/// An image in which every pixel has the same premultiplied colour.
inline Image plain_picture(ImageSize size, float light, float alpha) {
  Image image(size);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = i % 4 == 3 ? alpha : light;
  return image;
}

/// Random light and alpha.
inline Image noise(ImageSize size, unsigned seed) {
  Image image(size);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const float alpha = unit(random);
    for (std::size_t c = 0; c < 3; ++c) image.rgba[i + c] = alpha * unit(random);
    image.rgba[i + 3] = alpha;
  }
  return image;
}

/// How much of a pixel black ink covers, in a layer whose halo is white. If c is the coverage of ink and h that of the
/// halo, alpha is c + h (1 - c), and the light is h (1 - c).
inline float black_ink(const Image& layer, int x, int y) {
  const float* pixel = &layer.rgba[4 * layer.index(x, y)];
  return pixel[3] - pixel[0];
}

/// All annotations.
inline Annotation everything() {
  Annotation all;
  all.color_bar = ColorBar{.title = "pressure [Pa]"};
  all.axes = Axes{.triad = true, .box = true};
  all.outline = Outline{};
  all.scale_bar = ScaleBar{};
  all.texts = {{"top left"}, {"two\nlines", Place::top}, {"bottom", Place::bottom}, {"left", Place::left}};
  all.style.length_unit = "mm";
  return all;
}

inline TransferFunction ramp(double low = 0, double high = 10) {
  return TransferFunction({{low, {0.0, 0.125, 1.0}, 0}, {high, {1.0, 0.125, 0.25}, 2}});
}

}  // namespace tessera::annotation
