// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "scene/surface_set.hpp"
#include "volume/bricks/lane_samples.hpp"

namespace tessera::volume {

/// The iso-surfaces of a frame as kernels want them (surface_pieces-inl.h).
///
/// Edges    number 0 is below every value, 1 to `count` are the surfaces' values, ascending, and count + 1 is above
///          all. A field in gap n is at edge n or above it, and below edge n + 1.
/// Arrays   by edge, as lane scalars; longer than that, so that a vector can be read at their front.
struct SurfaceView {
  std::size_t count = 0;
  std::vector<float> edge, rest;  ///< the value rounded, and what rounding left off
  std::vector<float> exact;       ///< 1 where lanes hold samples and value exactly, and no other one there, else 0
  std::vector<float> red, green, blue, opacity;
  std::vector<float> angle_weight;  ///< light that differs for a radian between normal and ray, at most
  float ambient = 0, diffuse = 0, specular = 0, shininess = 0;
  int whole_shininess = -1;  ///< -1: it is no whole number, or a large one
  float noise = 0;           ///< of the field in float lanes, lane scalars, anywhere in the volume
  float brightest = 1;       ///< light or opacity that may come along a ray
  bool any_exact = false;
  float value_noise = 0;     ///< of a sample in float lanes, as a part of itself
  double unit = 1;           ///< world units a world gradient is taken per
  double metric[3][3] = {};  ///< squares of world gradients, as ShadingView has them
  float stretched = 1;       ///< longest world gradient of a step of one a voxel

  SurfaceView() = default;
  SurfaceView(const scene::SurfaceSet& surfaces, const LaneSamples& lanes);
};

}  // namespace tessera::volume
