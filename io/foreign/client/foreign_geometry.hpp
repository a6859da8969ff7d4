// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "io/foreign/messages/foreign_data.hpp"
#include "scene/grid.hpp"

namespace tessera::io {

/// Origin, spacing and direction of an image.
void set_image_geometry(const ForeignPart& image, scene::GridGeometry& geometry);

/// Along one axis of a rectilinear grid.
struct AxisCoordinates {
  NumberType type = NumberType::float64;  ///< as they were stored
  std::vector<double> values{};
};

/// Coordinates of a grid, whose direction is that of its axes. Falling ones are turned over by a mirrored direction.
/// Those of all axes that are even but for their rounding make a regular grid: many writers know no other kind, and
/// regular grids are cast much faster.
void set_rectilinear_geometry(std::array<AxisCoordinates, 3> axes, scene::GridGeometry& geometry);

}  // namespace tessera::io
