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

/// Steps of the transfer function. A field may be within a few last places of a step's value in a whole region, like
/// saturated fields (tanh, volume of fluid): the last places then determine on which side of the step a ray is, and
/// where it crosses it.
namespace tessera::projection {

/// A value at which the transfer function steps. Scalars equal to the value are on the upper side.
struct Step {
  double value;
  double contrast;       ///< bounds the change of a pixel per world length on the wrong side
  bool surface = false;  ///< an iso-surface at this value
};

/// The function's steps, ascending. `longest_ray` bounds a ray's world length in the mesh.
std::vector<Step> steps_of(const scene::TransferFunction& function, scene::Emission emission, double longest_ray);

/// These steps and the iso-surfaces, if there are any.
std::vector<Step> with_surfaces(std::vector<Step> steps, const IsoView* iso);

/// Cells in which rounded scalars would not determine accurately enough where rays cross a step. The criterion is the
/// error of a scalar, divided by the change of the scalar in the cell, times the change of a pixel if the whole ray
/// were in cells like this. Their segments must be cut at the steps (SplitRasterizer).
///
/// The result for a cell depends on its own scalars and corners and on data that all processes share: its segments have
/// the same bits wherever it is projected.
class CellsAtSteps {
 public:
  CellsAtSteps() = default;
  /// `steps` must outlive this object. `lattice`: the lattice to which scalars are rounded; null: double precision.
  /// Work runs in the caller's task arena (oneTBB). Throws scene::FrameStopped once `stop` is requested. Each member of
  /// a team examines its share of the cells, and all have all results.
  CellsAtSteps(const PreparedMesh& prepared, std::span<const Step> steps, double longest_ray,
               const scene::Lattice* lattice, const std::stop_token& stop = {}, scene::Team* team = nullptr);

  [[nodiscard]] bool contain(std::uint32_t tet) const { return !empty() && (bits_[tet / 64] >> tet % 64 & 1) != 0; }
  [[nodiscard]] bool empty() const { return bits_.size() == 0; }
  /// Bounds the number of segments of one of these cells in a pixel.
  [[nodiscard]] std::size_t most_pieces() const { return most_pieces_; }

 private:
  LargeArray<std::uint64_t> bits_;  ///< one per tet; empty if there are none
  std::size_t most_pieces_ = 1;
};

/// Rasterizes single cells, with their segments cut where they cross steps: no segment has a step's value between its
/// ends, and one below a step has an end below its value. Scalars are interpolated as differences to the nearest step,
/// so that scalars that differ from it by a double's last place are as accurate as others. Where a segment crosses a
/// surface of ProjectedMesh::iso, a crossing follows (surface_crossings.hpp): the steps must include the surfaces.
/// `Segments`: RaySegments, or AttributeSegments, whose attribute is cut, too.
template <class Segments>
class SplitRasterizer {
 public:
  /// Same as rasterize_planes() for this cell, for all of `rect`. The segments are valid until the next call.
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

/// Ends of a SplitRasterizer's segment in steps of the lattice, as floats, on the same sides of all steps as before.
struct LatticeScalars {
  float front, back;
};
LatticeScalars lattice_scalars(double front, double back, std::span<const Step> steps, const scene::Lattice& lattice);

}  // namespace tessera::projection
