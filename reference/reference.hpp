// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "reference/layers.hpp"
#include "reference/matter_light.hpp"
#include "reference/mesh/ray_tet.hpp"
#include "reference/mesh/surface_on_ray.hpp"
#include "reference/ray_reference.hpp"
#include "reference/view.hpp"
#include "scene/camera.hpp"
#include "scene/optical_model.hpp"
#include "scene/selection.hpp"
#include "scene/tet_mesh.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::reference {

/// The interval of one view ray inside one tetrahedron, after clipping.
struct RaySegment {
  double front, back;  ///< planar depth: world units along the view direction from the camera's position
  double length;       ///< world length along the ray; zero in a flat cell
  double scalar_front, scalar_back;
  double corner_scalar, change_front, change_back;  ///< the same scalars as in Stretch
  std::size_t tet;
  int face_front, face_back;  ///< as in Stretch
};

/// The slow, exact renderer with which the fast one is compared. Brute force in double precision: every ray is
/// intersected with every tetrahedron whose projected box contains it. It has no acceleration structure, does not skip
/// invisible cells, and shares no code with the fast renderer except the plain values of scene/.
///
/// Hits     are decided exactly, with the tie rule of ray_tet.hpp: along any ray, the segments tile the mesh's
///          interval.
/// Order    (front, back, tet index).
/// Error    about 1e-13 in linear RGBA. Cell data is constant in a tet, point data linear between the two hits.
/// Surfaces Iso-surfaces are crossed where the scalar changes, between the ends of a segment, from below a value to the
///          value or above, or back. If there are several crossings at one depth, they are in the order along the
///          segment. They are lit by the tet's gradient. Surfaces of triangles are met where the ray intersects a
///          triangle. A boundary is met where a segment ends at a face that only one cell has, or where a half-space's
///          plane cuts a cell. Segments are cut at triangles and boundaries, so that these have their true depth even
///          in cells that overlap. At one depth the order is: the surfaces at a cell's back end, the cell's boundary,
///          triangles, cells of length zero, the next cell's boundary, and the surfaces at that cell's front end.
///          Depths count as equal if a shift of the ray by 2^-32 pixel may exchange them (shaded_ray.cpp).
/// Shading  of point data by each tet's own gradient (scene/shading.hpp).
/// Threads  const functions may be called from several threads; `pixels` and `image` use all cores themselves.
/// Cost     256x256 pixels over 0.5 M tets: seconds to a minute. One point query is a pass over all tets' boxes.
class Reference final : public RayReference, public LayerReference {
 public:
  /// The mesh must outlive the reference. Only the part of every ray inside all half-spaces counts (kept_interval.hpp);
  /// cells are not cut. Throws scene::Error(bad_input) for an invalid camera or size, an empty transfer function, or a
  /// mesh that violates its invariants.
  Reference(const scene::TetMeshView& mesh, const scene::Camera& camera, scene::ImageSize size,
            const scene::TransferFunction& transfer_function, scene::Emission emission = scene::Emission::absorption,
            const Surfaces& surfaces = {}, std::span<const scene::HalfSpace> kept = {},
            const std::optional<scene::Shading>& shading = std::nullopt);

  /// Returns the segments of the ray through pixel coordinates (x, y), front to back. Pixel (i, j) has its centre at (i
  /// + 0.5, j + 0.5).
  [[nodiscard]] std::vector<RaySegment> segments(double x, double y) const;

  /// Returns the colour of the ray through pixel coordinates (x, y), at any position, not only pixel centres.
  [[nodiscard]] Pixel pixel(double x, double y) const override;

  /// Returns the colours of the rays through the centres of `wanted`, in that order. `threads` 0: all cores.
  [[nodiscard]] std::vector<Pixel> pixels(std::span<const PixelIndex> wanted, int threads = 0) const override;

  [[nodiscard]] std::vector<Pixel> layers(double x, double y, const Peel& peel) const override;
  [[nodiscard]] std::vector<std::vector<Pixel>> layers(std::span<const PixelIndex> wanted, const Peel& peel,
                                                       int threads = 0) const override;

  /// Returns every pixel, row-major, row 0 at the top.
  [[nodiscard]] std::vector<Pixel> image(int threads = 0) const;

  [[nodiscard]] scene::ImageSize size() const override { return size_; }

 private:
  /// Pixel coordinates outside which no ray meets the tet.
  struct Box {
    double x_low, y_low, x_high, y_high;
  };
  [[nodiscard]] std::array<Corner, 4> corners(std::size_t tet) const;
  [[nodiscard]] Box box(std::size_t tet) const;
  void trace(std::size_t tet, const std::array<Corner, 4>& corners, double x, double y,
             std::vector<RaySegment>& segments) const;
  [[nodiscard]] Box box(std::span<const ProjectedVertex> vertices) const;
  void project(const Surfaces& surfaces);
  [[nodiscard]] std::vector<TriangleCrossing> triangles_on(double x, double y) const;
  [[nodiscard]] glm::dvec3 face_normal(std::size_t tet, int face) const;
  class Ray;
  /// Returns the colour of a ray, given its sorted segments.
  [[nodiscard]] Pixel shaded(std::span<const RaySegment> segments, double x, double y) const;
  [[nodiscard]] std::vector<Pixel> layers(std::span<const RaySegment> segments, double x, double y,
                                          const Peel& peel) const;
  /// Passes each ray's sorted segments, with its index in `wanted`, to `take`, which is called from any thread.
  void each_ray(std::span<const PixelIndex> wanted, int threads,
                const std::function<void(std::size_t, std::span<const RaySegment>)>& take) const;

  scene::TetMeshView mesh_;
  scene::ImageSize size_;
  std::vector<scene::Knot> knots_;
  scene::Emission emission_;
  std::vector<scene::HalfSpace> kept_;
  View view_;
  std::vector<SurfaceOfValue> surfaces_;
  SurfaceLight light_;
  std::optional<MatterLight> matter_light_;
  scene::TransferFunction function_;      ///< set if a surface of faces has the colours of the transfer function
  std::vector<Paint> boundary_, paints_;  ///< paints_: indexed by ProjectedTriangle::paint
  std::vector<std::uint8_t> open_;        ///< result of open_faces(), if there is a boundary
  std::vector<ProjectedTriangle> triangles_;
  std::vector<Box> triangle_boxes_;
  std::vector<ProjectedVertex> vertices_;
  std::vector<Box> boxes_;
};

}  // namespace tessera::reference
