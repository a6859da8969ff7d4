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

/// A ray's stretch in one voxel, planar depths z0 to z1. `corner` a + 2 b + 4 c is the value at the voxel's corner
/// (a, b, c), all the same for cell data; the ray is at `front` of the unit cube at z0, and at front + rise at z1.
struct VoxelStretch {
  double z0, z1;
  std::array<double, 8> corner;
  glm::dvec3 front, rise, side;  ///< side: of the voxel, world units along the grid's axes
};

/// What a walk finds, front to back.
class WalkSink {
 public:
  virtual ~WalkSink() = default;
  /// The ray has come to a voxel of which something shows.
  virtual void enter(const VoxelStretch& stretch) = 0;
  /// In it the scalar goes in a straight line between planar depths z0 and z1, within one interval of the transfer
  /// function, from knot number k_0 to k_1: n + t is at t in [0, 1] of the way from knot n to the next, n from 0 on;
  /// below 0 and from the last number on nothing changes. So scalars keep their places between knots that are much
  /// closer than they are large. over_knot_numbers() is the function to look them up in.
  virtual void line(double z0, double z1, double k_0, double k_1) = 0;
  /// At most what is let through so far; below `least` the walk ends.
  [[nodiscard]] virtual double transmittance() const = 0;
};

/// The transfer function with its knots at 0, 1, 2 and so on; the two knots of a step have numbers of their own.
scene::TransferFunction over_knot_numbers(const scene::TransferFunction& function);

struct WalkSettings {
  scene::Emission emission = scene::Emission::absorption;
  double tolerance = 2e-9;  ///< linear RGBA, a stretch taken for a line
  double least = 0;         ///< transmittance at which the walk ends
  /// One byte for each cell of 8^3 voxels (cell_ranges.hpp): whether something of it shows; empty: all may.
  std::span<const std::uint8_t> visible = {};
};

/// Goes along rays from voxel to voxel in double precision, one thread's way: regular and rectilinear grids, point and
/// cell data. The cubic of the trilinear field is cut where it turns and at the knots of the transfer function, and
/// into stretches so short that a line through its mean gives their light to the tolerance (ray_piece-inl.h has the
/// bound). The field is computed in differences to a knot among the voxel's values, or to the least of them: fields and
/// knots may differ by last places of doubles.
class VoxelWalk {
 public:
  VoxelWalk(const scene::SampleSource& source, const scene::TransferFunction& function, const WalkSettings& settings);

  void walk(const VoxelRay& ray, WalkSink& sink);

  /// Since it was made.
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
  double origin_ = 0;     ///< scalars in the voxel are counted from here
  double last_knot_ = 0;  ///< crossed, from there
  std::uint64_t voxels_ = 0;
};

}  // namespace tessera::volume
