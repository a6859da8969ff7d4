// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>

namespace tessera::volume {

/// The rays of one tile of 32x32 pixels for the lane kernels, and their accumulated light. Tiles and packets are at
/// fixed positions in the image.
///
/// Order     Packet by packet, a packet being 4x4 pixels: ray = packet * 16 + (y % 4) * 4 + x % 4.
/// Axes      k is the axis along which rays move most, mirrored if they move downwards, so that k increases along every
///           ray; (i, j) are the other two, i the lower. Units are voxels. A ray is at (x, y) = (ax + bx k, ay + by k),
///           with |bx|, |by| <= 1, between k_in and k_out (empty if k_in >= k_out).
/// Arrays    Structure of arrays with an element for every ray, including pixels outside the image.
struct TileRays {
  static constexpr int side = 32, packet_side = 4;
  static constexpr int packet_rays = packet_side * packet_side, packets = side * side / packet_rays;
  static constexpr int count = side * side;

  // The following are constant during the frame.
  alignas(64) double ax[count], bx[count], ay[count], by[count];
  alignas(64) double k_in[count], k_out[count];       ///< the part of the ray that is in the volume and in view
  alignas(64) double depth_0[count], depth_k[count];  ///< planar depth = depth_0 + depth_k * k, world units
  alignas(64) float length_k[count];                  ///< length of the ray per unit of k, in the table's unit
  alignas(64) float light_view[count];                ///< shading: cosine between the light and the view
  // The progress of the rays:
  alignas(64) double from[count], to[count];        ///< the part of [k_in, k_out] to be cast in the current chunk
  alignas(64) double begun[count], reached[count];  ///< first k cast since clear_light(), and last k cast
  // The light between `begun` and `reached`, and the k at which it begins; NaN if there is no light.
  alignas(64) float alpha[count], transmittance[count], red[count], green[count], blue[count];
  alignas(64) double first_k[count];
  alignas(64) float error_bound[count];    ///< errors in linear RGBA that add up linearly (lane_error_bound.hpp)
  alignas(64) float rough[count];          ///< sum of squares of independent rounding errors
  alignas(64) float carried[count];        ///< preintegrated: the field at the end of the last step
  alignas(64) float passed[count];         ///< transmittance of the parts whose light has been emitted already
  alignas(64) std::uint8_t closed[count];  ///< 1: the caller has ended the ray

  /// Resets the light and where it begins.
  void clear_light() {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (int r = 0; r < count; ++r) {
      alpha[r] = red[r] = green[r] = blue[r] = 0;
      transmittance[r] = 1;
      error_bound[r] = rough[r] = 0;
      first_k[r] = nan;
      begun[r] = std::numeric_limits<double>::infinity();
    }
  }

  static constexpr int pixel_x(int ray) {
    return ray / packet_rays % (side / packet_side) * packet_side + ray % packet_side;
  }
  static constexpr int pixel_y(int ray) {
    return ray / packet_rays / (side / packet_side) * packet_side + ray % packet_rays / packet_side;
  }
  /// The ray of a pixel; coordinates are relative to the tile's first pixel.
  static constexpr int ray_of(int x, int y) {
    return (y / packet_side * (side / packet_side) + x / packet_side) * packet_rays + y % packet_side * packet_side +
           x % packet_side;
  }
};

/// The axes of the volume that TileRays calls i, j and k.
struct RayAxes {
  int i = 0, j = 1, k = 2;
  bool mirrored = false;  ///< k counts downwards from the last lattice point

  static constexpr int codes = 6;

  [[nodiscard]] static RayAxes of(int code) {
    const int k = code / 2;
    return {k == 0 ? 1 : 0, k == 2 ? 1 : 2, k, code % 2 == 1};
  }
};

}  // namespace tessera::volume
