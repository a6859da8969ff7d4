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

/// Steps of the transfer function. A field may lie within a few last places of a step's value over a whole region, as
/// saturated fields do (tanh, volume of fluid): there the last places say on which side of the step a ray is, and where
/// it crosses it.
namespace tessera::projection {

/// A value at which the transfer function steps. What lies at the value or above is on its upper side.
struct Step {
  double value;
  double contrast;       ///< bounds what a world length taken for the wrong side changes of a pixel
  bool surface = false;  ///< an iso-surface, which is crossed there
};

/// The function's steps, ascending. `longest_ray` bounds a ray's world length in the mesh.
std::vector<Step> steps_of(const scene::TransferFunction& function, scene::Emission emission, double longest_ray);

/// The same and the iso-surfaces, if there are any.
std::vector<Step> with_surfaces(std::vector<Step> steps, const IsoView* iso);

/// Cells of which rounded scalars would not tell well enough where rays cross a step: the error of a scalar, over the
/// change of the scalar in the cell, times what the whole ray could change of a pixel if it ran through such cells
/// alone. Their segments are to be cut at the steps (SplitRasterizer).
///
/// A cell's answer depends on its own scalars and corners and on what all processes agree on: its segments have the
/// same bits wherever it is projected.
class CellsAtSteps {
 public:
  CellsAtSteps() = default;
  /// `steps` must outlive this object. `lattice`: on which scalars are kept; null: in double precision. Work runs in
  /// the caller's task arena (oneTBB). Throws scene::FrameStopped once `stop` is asked for. A team's members look at
  /// their share of the cells each, and all have all answers.
  CellsAtSteps(const PreparedMesh& prepared, std::span<const Step> steps, double longest_ray,
               const scene::Lattice* lattice, const std::stop_token& stop = {}, scene::Team* team = nullptr);

  [[nodiscard]] bool contain(std::uint32_t tet) const { return !empty() && (bits_[tet / 64] >> tet % 64 & 1) != 0; }
  [[nodiscard]] bool empty() const { return bits_.size() == 0; }
  /// Bounds the segments that one of these cells has in a pixel.
  [[nodiscard]] std::size_t most_pieces() const { return most_pieces_; }

 private:
  LargeArray<std::uint64_t> bits_;  ///< one a tet; empty if there are none
  std::size_t most_pieces_ = 1;
};

/// Rasterizes single cells with their segments cut where they cross steps: no segment has a step's value between its
/// ends, and one that is below a step has an end below its value. Scalars are interpolated as differences to the
/// nearest step, so that those which differ from it by a double's last place are as good as any. Where
/// ProjectedMesh::iso has a surface that the segment crosses, a crossing follows (surface_crossings.hpp): the steps
/// must have the surfaces among them. `Segments`: RaySegments, or AttributeSegments, whose attribute is cut too.
template <class Segments>
class SplitRasterizer {
 public:
  /// As rasterize_planes() of this cell alone, for all of `rect`. The segments stay until the next call.
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

/// Ends of a SplitRasterizer's segment in the lattice's steps, as floats, on the sides of all steps that they are on.
struct LatticeScalars {
  float front, back;
};
LatticeScalars lattice_scalars(double front, double back, std::span<const Step> steps, const scene::Lattice& lattice);

}  // namespace tessera::projection
