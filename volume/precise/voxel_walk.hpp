// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/optical_model.hpp"
#include "scene/sample_source.hpp"
#include "scene/transfer_function.hpp"
#include "volume/bricks/sample_blocks.hpp"
#include "volume/precise/voxel_ray.hpp"

namespace tessera::volume {

/// A ray's stretch in one voxel, between planar depths z0 and z1. Element a + 2 b + 4 c of `corner` is the value at the
/// voxel's corner (a, b, c); all are the same for cell data. In the unit cube of the voxel, the ray is at `front` at
/// z0, and at front + rise at z1.
struct VoxelStretch {
  double z0, z1;
  std::array<double, 8> corner;
  glm::dvec3 front, rise, side;  ///< `side`: size of the voxel, in world units along the grid's axes
};

/// Receives the results of a walk, front to back.
class WalkSink {
 public:
  virtual ~WalkSink() = default;
  /// Called when the ray enters a voxel in which something is visible.
  virtual void enter(const VoxelStretch& stretch) = 0;
  /// Called for a stretch between planar depths z0 and z1 on which the scalar is linear and within one interval of the
  /// transfer function. k_0 and k_1 are the scalars at its ends, expressed as knot numbers: number n + t is at the
  /// fraction t in [0, 1] between knots n = 0, 1, ... and n + 1. The function is constant below 0 and from the last
  /// number on. Knot numbers keep the position of a scalar between two knots even if the knots differ only in their
  /// last places. over_knot_numbers() is the transfer function as a function of knot numbers.
  virtual void line(double z0, double z1, double k_0, double k_1) = 0;
  /// Upper bound of the transmittance so far; the walk ends if it is below `least`.
  [[nodiscard]] virtual double transmittance() const = 0;
};

/// Returns the transfer function with its knots moved to 0, 1, 2 and so on; the two knots of a step have different
/// numbers.
scene::TransferFunction over_knot_numbers(const scene::TransferFunction& function);

struct WalkSettings {
  scene::Emission emission = scene::Emission::absorption;
  double tolerance = 2e-9;  ///< largest error, in linear RGBA, of replacing a stretch by a line
  double least = 0;         ///< transmittance at which the walk ends
  /// One byte for each cell of 8^3 voxels (cell_ranges.hpp): whether any part of the cell is visible. If empty, any
  /// cell may be visible.
  std::span<const std::uint8_t> visible = {};
};

/// Walks along rays from voxel to voxel in double precision, for regular and rectilinear grids with point or cell data.
/// A walk is used by one thread. The cubic of the trilinear field is divided at its extrema and at the knots of the
/// transfer function, and into stretches so short that a line with the same mean gives their light within the tolerance
/// (ray_piece-inl.h derives the bound). The field is computed relative to a knot among the voxel's values, or to the
/// least of them, because fields and knots may differ only in the last places of doubles.
class VoxelWalk {
 public:
  VoxelWalk(const scene::SampleSource& source, const scene::TransferFunction& function, const WalkSettings& settings);

  void walk(const VoxelRay& ray, WalkSink& sink);

  /// These counts start at construction.
  struct Counts {
    std::uint64_t voxels = 0, blocks_read = 0, bytes_read = 0;
  };
  [[nodiscard]] Counts counts() const { return {voxels_, blocks_.blocks_read(), blocks_.bytes_read()}; }

 private:
  struct FieldCubic;
  struct CubicStretch;

  void cross(const VoxelRay& ray, const scene::GridIndex& voxel, double z0, double z1, WalkSink& sink);
  [[nodiscard]] double next_knot(double s, double crossed, bool up) const;
  [[nodiscard]] std::size_t knots_above(double s) const;
  [[nodiscard]] double knot_number(std::size_t above, double s) const;
  void add_smooth(const CubicStretch& stretch, double u0, double u1, int halvings, WalkSink& sink) const;
  [[nodiscard]] bool shows(double low, double high) const;

  const scene::GridGeometry& geometry_;
  WalkSettings settings_;
  scene::GridIndex cells_;
  SampleBlocks blocks_;
  std::vector<scene::Knot> knots_;
  bool independent_;
  double origin_ = 0;     ///< scalars in the current voxel are relative to this value
  double last_knot_ = 0;  ///< last knot that was crossed, relative to `origin_`
  std::uint64_t voxels_ = 0;
};

}  // namespace tessera::volume
