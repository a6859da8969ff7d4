// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "projection/planes_rasterizer.hpp"
#include "scene/lattice.hpp"

namespace tessera::projection {

/// A cell as one view sees it, all that a rasterizer on a device (gl_rasterizer.hpp) reads of it: what travels to the
/// compositor whose device it is, byte by byte.
///
/// Holds   corners in canonical order (PreparedMesh), each in front of the eye and inside the clipping range; x and y
///         are whole multiples of 2^-32 pixel, of size `reach` at most: where the tie rule sees the corner
///         (line_of_sight()), so that differences of them are exact in doubles and products in 128-bit integers.
struct CellRecord {
  struct Corner {
    double x, y;    ///< pixel position
    double depth;   ///< planar, world units
    double scalar;  ///< in the field's own unit; of cell data the same at all four
  };
  /// Pixels: eight times the largest picture's 2^16 would still do; beyond, a corner is as good as beside the eye.
  static constexpr double reach = 0x1p17;

  Corner corner[4];
  std::uint64_t tet;  ///< index in the whole mesh: the last key of the depth order
};
static_assert(sizeof(CellRecord) == 136);

/// Cell `tet` of the frame, `global_tet` in the whole mesh. None where a device cannot do it: a corner behind or beside
/// the eye or farther away than CellRecord::reach, or outside the clipping range.
std::optional<CellRecord> cell_record(const ProjectedMesh& projected, std::uint32_t tet, std::uint64_t global_tet);

/// What a device needs to know to make segments of cells.
struct CellUnits {
  double half_width, half_height;     ///< of the picture, pixels
  double pixels_per_tangent;          ///< PixelSpace's: 0 is an orthographic view
  scene::Lattice lattice;             ///< units of lengths (depth_unit) and scalars
  double key_origin, keys_per_depth;  ///< of the keys of depths: key = (planar depth - origin) * keys_per_depth
};

/// The same segments by rasterize_planes(), for compositors whose device failed under way: `take` gets them batch by
/// batch, with the cells of the batch that their tet numbers count. Scalars are in the field's own unit.
void rasterize_records(std::span<const CellRecord> cells, const scene::PixelRect& rect, double pixels_per_tangent,
                       const std::function<void(const RaySegments&, std::span<const CellRecord>)>& take);

}  // namespace tessera::projection
