// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "io/foreign/messages/foreign_data.hpp"
#include "scene/grid.hpp"

namespace tessera::io {

/// Copies origin, spacing and direction of an image to `geometry`.
void set_image_geometry(const ForeignPart& image, scene::GridGeometry& geometry);

/// The coordinates along one axis of a rectilinear grid.
struct AxisCoordinates {
  NumberType type = NumberType::float64;  ///< type in the file
  std::vector<double> values{};
};

/// Sets the coordinates of a rectilinear grid. Decreasing coordinates are reversed, and the direction of that axis is
/// mirrored. If all axes are uniformly spaced up to rounding, the grid becomes regular: many writers produce only
/// rectilinear grids, and regular grids are rendered much faster.
void set_rectilinear_geometry(std::array<AxisCoordinates, 3> axes, scene::GridGeometry& geometry);

}  // namespace tessera::io
