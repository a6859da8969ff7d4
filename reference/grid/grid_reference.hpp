// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/mat3x3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "reference/grid/grid_integral.hpp"
#include "reference/layers.hpp"
#include "reference/mesh/surface_on_ray.hpp"
#include "reference/ray_reference.hpp"
#include "reference/view.hpp"
#include "scene/optical_model.hpp"
#include "scene/sample_source.hpp"
#include "scene/selection.hpp"
#include "scene/shading.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::reference {

/// The slow, exact renderer of regular and rectilinear grids: every ray is intersected with every voxel along it, in
/// double precision. It has no acceleration structure, does not skip invisible voxels, and shares no code with the fast
/// renderer except the plain values of scene/.
///
/// Field    Point data: trilinear in each voxel, hence a cubic along the ray (grid_integral.hpp). Cell data: constant
///          in each voxel. A voxel with a blank corner (cell data: a blank sample) is a gap.
/// Domain   the box between the first and last lattice points.
/// Ties     a ray in a plane of the lattice (to 1e-9 of a voxel) belongs to the voxels that an infinitesimal shift of
///          the ray by (e, e^2) in (x, y) selects, as in ray_tet.hpp. The same applies at the volume's boundary.
/// Shading  as defined by scene/shading.hpp. A segment is between two crossings of lattice planes, the eye, the
///          clipping planes and surfaces. A gradient below 1e-12 of the voxel's samples counts as zero.
/// Surfaces of point data are intersected in each voxel as in grid_surface.hpp, and lit by the gradient of the
///          trilinear field. The sides of a gap are not surfaces.
/// Error    about 1e-12 in linear RGBA.
/// Cost     a microsecond or two per voxel along a ray. It stores no samples, so it can check volumes larger than
///          memory.
class GridReference final : public RayReference, public LayerReference {
 public:
  /// The source must outlive the reference. Only the parts of rays inside all half-spaces count (kept_interval.hpp).
  /// Throws scene::Error(bad_input) for an invalid camera or size, an empty transfer function, or shading of light that
  /// does not depend on extinction.
  GridReference(const scene::SampleSource& source, const scene::Camera& camera, scene::ImageSize size,
                const scene::TransferFunction& transfer_function,
                scene::Emission emission = scene::Emission::absorption,
                const std::optional<scene::Shading>& shading = std::nullopt,
                std::span<const scene::HalfSpace> kept = {}, const Surfaces& surfaces = {});

  /// In the result, `length` and `segments` count only parts that are not blank.
  [[nodiscard]] Pixel pixel(double x, double y) const override;
  [[nodiscard]] std::vector<Pixel> layers(double x, double y, const Peel& peel) const override;
  [[nodiscard]] std::vector<std::vector<Pixel>> layers(std::span<const PixelIndex> wanted, const Peel& peel,
                                                       int threads = 0) const override;
  [[nodiscard]] scene::ImageSize size() const override { return size_; }

 private:
  /// A view ray in the grid's local frame: at planar depth z it is at origin + z * step.
  struct LocalRay {
    glm::dvec3 origin, step;
    std::array<std::int64_t, 3> in_plane;  ///< for axes whose planes are parallel to the ray: its voxel; others: -1
    double begin, end;                     ///< planar depths inside the volume and view; empty if begin >= end
    double length_per_depth;
    bool begin_cut, end_cut;  ///< whether a clipping plane bounds the interval at its beginning and end
  };
  /// A voxel that a ray meets.
  struct Voxel {
    glm::dvec3 low, side;          ///< local
    std::array<double, 8> values;  ///< values at the voxel's corners, or its single value
    bool constant;
    [[nodiscard]] glm::dvec3 place(const glm::dvec3& local) const { return (local - low) / side; }
  };
  [[nodiscard]] LocalRay local_ray(double x, double y) const;
  /// Returns all depths at which a ray begins, ends or passes a plane of the lattice. Each depth is computed from its
  /// plane alone.
  [[nodiscard]] std::vector<double> plane_depths(const LocalRay& ray) const;
  /// Reads the voxel that contains the middle of a segment. Returns false if the voxel is a gap.
  [[nodiscard]] bool read_voxel(const LocalRay& ray, const glm::dvec3& middle, Voxel& voxel) const;
  /// Integrates the whole ray, and counts length and segments in `pixel`.
  void integrate(double x, double y, GridIntegral& integral, Pixel& pixel) const;
  void add_stretch(const LocalRay& ray, const Voxel& voxel, double z0, double z1, GridIntegral& integral) const;
  /// Adds the part of a segment between two surfaces.
  void add_part(const LocalRay& ray, const Voxel& voxel, double z0, double z1, GridIntegral& integral) const;
  /// Returns the light at a place of a voxel, 0 to 1 along each axis. `step_world` is a vector along the ray, away from
  /// the eye, of any length.
  [[nodiscard]] GridIntegral::Light light(const Voxel& voxel, const glm::dvec3& place,
                                          const glm::dvec3& step_world) const;
  [[nodiscard]] std::int64_t voxel_along(std::size_t axis, double local) const;

  const scene::SampleSource* source_;
  scene::ImageSize size_;
  std::vector<scene::Knot> knots_;
  scene::Emission emission_;
  std::vector<scene::HalfSpace> kept_;
  View view_;
  glm::dmat3 to_local_;
  std::optional<scene::Shading> shading_;
  glm::dvec3 to_light_{0};  ///< direction to the light in the world, unit length
  std::vector<SurfaceOfValue> surfaces_;
  SurfaceLight surface_light_;
};

}  // namespace tessera::reference
