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

/// The stretch of one view ray inside one tetrahedron, after clipping.
struct RaySegment {
  double front, back;  ///< planar depth: world units along the view direction from the camera's position
  double length;       ///< world length along the ray; zero in a flat cell
  double scalar_front, scalar_back;
  double corner_scalar, change_front, change_back;  ///< the same scalars as in Stretch
  std::size_t tet;
  int face_front, face_back;  ///< as in Stretch
};

/// The slow, exact renderer that the fast one is judged against. Brute force in double precision: every ray against
/// every tetrahedron whose projected box holds it; no acceleration structure, no shortcut for invisible cells, no code
/// shared with the fast way but the plain values of scene/.
///
/// Hits     decided exactly, with the tie rule of ray_tet.hpp: along any ray the segments of a mesh tile its way.
/// Order    (front, back, tet index).
/// Error    about 1e-13 in linear RGBA. Cell data is constant in a tet, point data linear between the two hits.
/// Surfaces are crossed where the scalar goes from below a value to the value or above, or back, from one end of a
///          segment to the other; where two are crossed at one depth they come as along the segment. Lit by the tet's
///          gradient. Those of triangles are met where the ray goes through one, a boundary where a segment ends at a
///          face that one cell alone has, or where a half-space's plane cuts a cell. Segments are cut there, so that
///          they lie at their true depth in cells that overlap, too. At one depth what a cell has at its back end comes
///          first, its boundary, triangles, what is in cells of no length, the next cell's boundary, and what that has
///          at its front end. Depths are one if a shift of the ray by 2^-32 pixel may exchange them (shaded_ray.cpp).
/// Shading  of point data by each tet's own gradient (scene/shading.hpp).
/// Threads  const functions may be called from several threads; `pixels` and `image` use all cores themselves.
/// Cost     256x256 pixels over 0.5 M tets: seconds to a minute. One point query is a pass over all tets' boxes.
class Reference final : public RayReference, public LayerReference {
 public:
  /// The mesh must outlive the reference. Of every ray what lies in all half-spaces counts (kept_interval.hpp); cells
  /// are not cut. Throws scene::Error(bad_input) for an invalid camera or size, an empty transfer function, or a mesh
  /// that breaks its invariants.
  Reference(const scene::TetMeshView& mesh, const scene::Camera& camera, scene::ImageSize size,
            const scene::TransferFunction& transfer_function, scene::Emission emission = scene::Emission::absorption,
            const Surfaces& surfaces = {}, std::span<const scene::HalfSpace> kept = {},
            const std::optional<scene::Shading>& shading = std::nullopt);

  /// The ray through pixel coordinates (x, y), front to back. Pixel (i, j) has its centre at (i + 0.5, j + 0.5).
  [[nodiscard]] std::vector<RaySegment> segments(double x, double y) const;

  /// The same ray's colour. Any position, not only pixel centres.
  [[nodiscard]] Pixel pixel(double x, double y) const override;

  /// The rays through the centres of `wanted`, in that order. `threads` 0: all cores.
  [[nodiscard]] std::vector<Pixel> pixels(std::span<const PixelIndex> wanted, int threads = 0) const override;

  [[nodiscard]] std::vector<Pixel> layers(double x, double y, const Peel& peel) const override;
  [[nodiscard]] std::vector<std::vector<Pixel>> layers(std::span<const PixelIndex> wanted, const Peel& peel,
                                                       int threads = 0) const override;

  /// Every pixel, row-major, row 0 at the top.
  [[nodiscard]] std::vector<Pixel> image(int threads = 0) const;

  [[nodiscard]] scene::ImageSize size() const override { return size_; }

 private:
  /// Pixel coordinates outside of which no ray meets the tet.
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
  /// Of segments in order.
  [[nodiscard]] Pixel shaded(std::span<const RaySegment> segments, double x, double y) const;
  [[nodiscard]] std::vector<Pixel> layers(std::span<const RaySegment> segments, double x, double y,
                                          const Peel& peel) const;
  /// Gives each ray's segments in order, with its place in `wanted`, to a function that any thread calls.
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
  scene::TransferFunction function_;      ///< if a surface of faces has its colours
  std::vector<Paint> boundary_, paints_;  ///< the latter by ProjectedTriangle::paint
  std::vector<std::uint8_t> open_;        ///< if there is a boundary: open_faces()
  std::vector<ProjectedTriangle> triangles_;
  std::vector<Box> triangle_boxes_;
  std::vector<ProjectedVertex> vertices_;
  std::vector<Box> boxes_;
};

}  // namespace tessera::reference
