// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "scene/surface_set.hpp"
#include "volume/bricks/lane_samples.hpp"

namespace tessera::volume {

/// The iso-surfaces of a frame in the form that the kernels need (surface_pieces-inl.h).
///
/// Edges     Edge 0 is below every value, edges 1 to `count` are the surfaces' values in ascending order, and edge
///           count + 1 is above all values. A field in gap n is at or above edge n, and below edge n + 1.
/// Arrays    Indexed by edge, in lane scalars; padded so that a whole vector can be read from the first element.
struct SurfaceView {
  std::size_t count = 0;
  std::vector<float> edge, rest;  ///< the value rounded to float, and the rounding error
  std::vector<float> exact;       ///< 1 if lanes represent samples and all values of this edge exactly, else 0
  std::vector<float> red, green, blue, opacity;
  std::vector<float> angle_weight;  ///< upper bound of the change of light per radian between normal and ray
  float ambient = 0, diffuse = 0, specular = 0, shininess = 0;
  int whole_shininess = -1;  ///< the shininess if it is a small integer, otherwise -1
  float noise = 0;           ///< error of the field in float lanes, anywhere in the volume, in lane scalars
  float brightest = 1;       ///< upper bound of the light or opacity along a ray
  bool any_exact = false;
  float value_noise = 0;     ///< relative error of a sample in float lanes
  double unit = 1;           ///< length unit of world gradients, in world units
  double metric[3][3] = {};  ///< for squared lengths of world gradients, as in ShadingView
  float stretched = 1;       ///< largest length of a world gradient whose index gradient is a unit step along an axis

  SurfaceView() = default;
  SurfaceView(const scene::SurfaceSet& surfaces, const LaneSamples& lanes);
};

}  // namespace tessera::volume
