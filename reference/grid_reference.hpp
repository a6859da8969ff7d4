#pragma once

#include <span>
#include <vector>

#include "reference/ray_reference.hpp"
#include "reference/view.hpp"
#include "scene/optical_model.hpp"
#include "scene/sample_source.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::reference {

/// The slow, exact renderer of regular and rectilinear grids: every ray against every voxel on its way, in double
/// precision. No acceleration structure, no shortcut for invisible voxels, no code shared with the fast way but the
/// plain values of scene/.
///
/// Field    point data: trilinear in each voxel, hence a cubic along the ray (grid_integral.hpp). Cell data: constant
/// in
///          each voxel. A voxel with a blank corner (cell data: a blank sample) is a gap.
/// Domain   the box between the first and last lattice points.
/// Ties     a ray that runs in a plane of the lattice (to 1e-9 of a voxel) belongs to the voxels that an infinitesimal
///          shift of the ray by (e, e^2) in (x, y) selects, as in ray_tet.hpp. So does one in the volume's boundary.
/// Error    about 1e-12 in linear RGBA.
/// Cost     a microsecond or two a voxel met. It keeps no samples: volumes larger than memory can be checked.
class GridReference final : public RayReference {
 public:
  /// The source must outlive the reference. Throws scene::Error(bad_input) for an invalid camera or size, or an empty
  /// transfer function.
  GridReference(const scene::SampleSource& source, const scene::Camera& camera, scene::ImageSize size,
                const scene::TransferFunction& transfer_function,
                scene::Emission emission = scene::Emission::absorption);

  /// `length` and `segments` count what is not blank.
  [[nodiscard]] Pixel pixel(double x, double y) const override;
  [[nodiscard]] std::vector<Pixel> pixels(std::span<const PixelIndex> wanted, int threads = 0) const override;
  [[nodiscard]] scene::ImageSize size() const override { return size_; }

 private:
  /// A view ray in the grid's local frame: at planar depth z it is at origin + z * step.
  struct LocalRay {
    glm::dvec3 origin, step;
    std::array<std::int64_t, 3> in_plane;  ///< the voxel along an axis whose planes the ray is parallel to, else -1
    double begin, end;                     ///< planar depths in the volume and in view; empty if begin >= end
  };
  [[nodiscard]] LocalRay local_ray(double x, double y) const;
  [[nodiscard]] std::int64_t voxel_along(std::size_t axis, double local) const;

  const scene::SampleSource* source_;
  scene::ImageSize size_;
  std::vector<scene::Knot> knots_;
  scene::Emission emission_;
  View view_;
  glm::dmat3 to_local_;
};

}  // namespace tessera::reference
