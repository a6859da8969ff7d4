// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "projection/large_array.hpp"
#include "projection/planes_rasterizer.hpp"
#include "scene/lattice.hpp"
#include "scene/optical_model.hpp"
#include "scene/team.hpp"
#include "scene/transfer_function.hpp"

/// Steps of the transfer function. In saturated fields (tanh, volume of fluid), the values in a whole region may differ
/// from a step's value only in the last places. The last places then determine on which side of the step a ray is, and
/// where the ray crosses it.
namespace tessera::projection {

/// A value at which the transfer function steps. A scalar that equals the value is on the upper side.
struct Step {
  double value;
  double contrast;  ///< upper bound of a pixel's change per world length of ray on the wrong side
  enum class Kind { step, surface, range_end } kind = Kind::step;  ///< surface: the value of an iso-surface
};

/// Whether the function jumps at some value.
bool has_steps(const scene::TransferFunction& function);

/// Returns the function's steps, ascending. `longest_ray` is an upper bound of a ray's world length in the mesh.
std::vector<Step> steps_of(const scene::TransferFunction& function, scene::Emission emission, double longest_ray);

/// Returns these steps together with the values of the iso-surfaces, and the ends of the magnified ranges; `iso` may be
/// null.
std::vector<Step> with_cuts(std::vector<Step> steps, const IsoView* iso,
                            std::span<const scene::MagnifiedRange> magnified);

/// Cells in which rounded scalars would not determine accurately enough where rays cross a step. The segments of these
/// cells must be cut at the steps (SplitRasterizer). The criterion is the error of a scalar, divided by the change of
/// the scalar in the cell, times the change of a pixel if the whole ray were in cells like this. Cells whose scalars
/// reach a magnified range (scene::MagnifiedRange) are included.
///
/// The result for a cell depends only on the cell's scalars and corners and on data that all processes share. So the
/// segments of the cell have the same bits wherever it is projected.
class CellsAtSteps {
 public:
  CellsAtSteps() = default;
  /// `steps` must outlive this object. `lattice` is the lattice to which scalars are rounded; null: scalars are in
  /// double precision. Runs in the caller's task arena (oneTBB). Throws scene::FrameStopped once `stop` is requested.
  /// Each member of a team examines its share of the cells, and all members get all results.
  CellsAtSteps(const PreparedMesh& prepared, std::span<const Step> steps, double longest_ray,
               const scene::Lattice* lattice, std::span<const scene::MagnifiedRange> magnified = {},
               const std::stop_token& stop = {}, scene::Team* team = nullptr);

  [[nodiscard]] bool contain(std::uint32_t tet) const { return !empty() && (bits_[tet / 64] >> tet % 64 & 1) != 0; }
  [[nodiscard]] bool empty() const { return bits_.size() == 0; }
  /// Upper bound of the number of segments that one of these cells has in a pixel.
  [[nodiscard]] std::size_t most_pieces() const { return most_pieces_; }

 private:
  LargeArray<std::uint64_t> bits_;  ///< one bit per tet; empty if there are no such cells
  std::size_t most_pieces_ = 1;
};

/// Rasterizes single cells, and cuts their segments where they cross steps: no segment has a step's value between its
/// ends, and a segment below a step ends below the step's value. Scalars are interpolated as differences from the
/// nearest step, so that scalars that differ from a step by a double's last place are as accurate as others. Where a
/// segment crosses a surface of ProjectedMesh::iso, a crossing follows (surface_crossings.hpp); the steps must include
/// the surfaces. `Segments`: RaySegments, or AttributeSegments, whose attribute is cut, too.
template <class Segments>
class SplitRasterizer {
 public:
  /// Makes the same segments as rasterize_planes() for this cell and all of `rect`, but cuts them at the steps. The
  /// segments are valid until the next call.
  const Segments& rasterize(const ProjectedMesh& projected, std::span<const Step> steps, const TileEntry& entry,
                            const scene::PixelRect& rect, RasterCounts& counts);

 private:
  void split(std::size_t segment, std::span<const Step> steps, double origin);
  void cross(std::size_t segment, const IsoView& iso, IsoView::Range range, double origin, const glm::dvec3& ray,
             const glm::dvec3& normal);

  Segments whole_, pieces_;
};
extern template class SplitRasterizer<RaySegments>;
extern template class SplitRasterizer<AttributeSegments>;

/// Converts the scalars at the ends of a SplitRasterizer's segment to steps of the lattice, as floats that are on the
/// same sides of all steps of the function as before. Scalars in a magnified range are moved to the magnified copy of
/// the range.
struct LatticeScalars {
  float front, back;
};
LatticeScalars lattice_scalars(double front, double back, std::span<const Step> steps, const scene::Lattice& lattice,
                               std::span<const scene::MagnifiedRange> magnified = {});

}  // namespace tessera::projection
