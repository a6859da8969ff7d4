// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "projection/planes_rasterizer.hpp"
#include "scene/lattice.hpp"

namespace tessera::projection {

/// A cell in one view, with all data that a rasterizer on a device (gl_rasterizer.hpp) needs. The record is sent, byte
/// for byte, to the compositor that has the device.
///
/// Holds   Corners are in canonical order (PreparedMesh). Each corner is in front of the eye and inside the clipping
///         range. x and y are integer multiples of 2^-32 pixel, at most `reach` in magnitude. They are the position of
///         the corner for the tie rule (line_of_sight()), so that differences are exact in doubles and products in
///         128-bit integers.
struct CellRecord {
  struct Corner {
    double x, y;    ///< pixel position
    double depth;   ///< planar, world units
    double scalar;  ///< in the field's own unit; for cell data, the same at all four corners
  };
  /// Largest magnitude of x and y, in pixels. Cells with corners beyond this limit are treated like cells with corners
  /// in the eye plane. The largest image has 2^16 pixels per side; a limit of eight times this size would also work.
  static constexpr double reach = 0x1p17;

  Corner corner[4];
  std::uint64_t tet;  ///< index in the whole mesh: the last part of the depth order's key
};
static_assert(sizeof(CellRecord) == 136);

/// Makes the record of the frame's cell `tet`; its index in the whole mesh is `global_tet`. Empty if a device cannot
/// rasterize the cell: a corner is behind or in the eye plane, farther away than CellRecord::reach, or outside the
/// clipping range.
std::optional<CellRecord> cell_record(const ProjectedMesh& projected, std::uint32_t tet, std::uint64_t global_tet);

/// The parameters with which a device makes segments from cells.
struct CellUnits {
  double half_width, half_height;     ///< half the size of the image, in pixels
  double pixels_per_tangent;          ///< as in PixelSpace: 0 for an orthographic view
  scene::Lattice lattice;             ///< units of lengths (depth_unit) and scalars
  double key_origin, keys_per_depth;  ///< for depth keys: key = (planar depth - origin) * keys_per_depth
};

/// Makes the segments that a device would make, by rasterize_planes(), for compositors whose device has failed. `take`
/// receives the segments in batches, together with the cells of the batch; a segment's tet number is an index of these
/// cells. Scalars are in the field's own unit.
void rasterize_records(std::span<const CellRecord> cells, const scene::PixelRect& rect, double pixels_per_tangent,
                       const std::function<void(const RaySegments&, std::span<const CellRecord>)>& take);

}  // namespace tessera::projection
