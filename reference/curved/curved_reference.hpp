// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "reference/curved/curved_inversion.hpp"
#include "reference/curved/curved_shapes.hpp"
#include "reference/mesh/cell_on_ray.hpp"
#include "reference/ray_reference.hpp"
#include "reference/view.hpp"
#include "scene/camera.hpp"
#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"
#include "tessera/association.hpp"

namespace tessera::reference {

/// Cells as VTK has them, of any order, with one scalar.
///
/// Shape   cell c has VTK's type types[c] and the nodes connectivity[offsets[c]] up to connectivity[offsets[c + 1]].
///         `degrees` are VTK's array HigherOrderDegrees: one entry a cell, or none. Scalars: one a position or one a
///         cell.
struct CurvedCells {
  std::span<const std::uint8_t> types;
  std::span<const std::uint64_t> offsets;
  std::span<const std::uint32_t> connectivity;
  std::span<const glm::dvec3> positions;
  Association association = Association::point;
  std::span<const double> scalars;
  std::span<const std::array<int, 3>> degrees{};
};

/// A stretch of one ray inside one cell, after clipping. A ray may pass through a curved cell several times.
struct CurvedSegment {
  double front, back;  ///< planar depth
  double length;       ///< world length along the ray
  std::size_t cell;
};

/// The slow, exact renderer of curved cells: every ray against the true faces of every cell whose box holds it, and the
/// field by isoparametric inversion along it. No subdivision of the mesh, no code shared with the fast way but the
/// plain values of scene/.
///
/// Cells    point data: geometry and field by the type's shape functions (curved_shapes.hpp). So linear hexahedra,
///          wedges, pyramids and voxels are trilinear here, with curved faces and a field that is not linear, while
///          `Reference` is given tets. Cell data: constant in a cell. Cells without a volume are passed over.
/// Faces    where the ray crosses them: curved_crossing.hpp. Between crossings: curved_inversion.hpp.
/// Light    the field as polynomials along the ray (smooth_scalar.hpp), integrated by curved_integral.hpp.
/// Order    (front, back, cell). Cells must not overlap, nor be folded: where the map from a cell's own coordinates to
///          space is not one to one, what is seen is finite but not defined, and may take up to a second.
/// Ties     no rule: a ray exactly through an edge or a node, or along a face, may miss a stretch, or have one of
///          rounding's length twice. Rays a little beside it are right.
/// Error    about 1e-12 in linear RGBA for cells of moderate shape; that of inversion grows as cells get flat.
/// Cost     20 to 100 microseconds a cell met, more where the ray nearly touches it.
class CurvedReference final : public RayReference {
 public:
  /// The cells are copied. Throws scene::Error(bad_input) for an invalid camera or size, an empty transfer function, a
  /// cell that is not what its type needs, an index or an array's length that does not fit, or numbers not finite.
  CurvedReference(const CurvedCells& cells, const scene::Camera& camera, scene::ImageSize size,
                  const scene::TransferFunction& transfer_function,
                  scene::Emission emission = scene::Emission::absorption);

  /// The ray through pixel coordinates (x, y), front to back.
  [[nodiscard]] std::vector<CurvedSegment> segments(double x, double y) const;

  /// `length` is that of all segments together, `segments` their number.
  [[nodiscard]] Pixel pixel(double x, double y) const override;
  [[nodiscard]] scene::ImageSize size() const override { return size_; }

 private:
  struct Cell {
    std::size_t shape;  ///< of shapes_
    std::size_t index;  ///< the caller's
    std::vector<glm::dvec3> control;
    std::vector<double> field;            ///< control values from `origin` on; empty if the field is constant
    double origin, change;                ///< `change`: the largest of the control values
    double x_low, y_low, x_high, y_high;  ///< pixel coordinates outside of which no ray meets the cell
  };
  /// A ray with the vectors across it; depths are planar.
  struct Frame {
    View::Ray ray;
    glm::dvec3 across_x, across_y;
    double length_per_depth;
  };
  struct Met {
    CurvedSegment segment;
    InnerPath path;
    const Cell* cell;
  };

  void add_cell(const CurvedCells& cells, std::size_t index, std::size_t shape);
  void bound(Cell& cell) const;
  [[nodiscard]] Frame frame(double x, double y) const;
  /// The control points of a cell in a ray's frame; `control` holds them.
  [[nodiscard]] CellOnRay on_ray(const Cell& cell, const Frame& frame, std::vector<glm::dvec3>& control) const;
  /// In order. `controls` is room for the cells' control points.
  [[nodiscard]] std::vector<Met> met(double x, double y, std::vector<std::vector<glm::dvec3>>& controls) const;

  scene::ImageSize size_;
  std::vector<scene::Knot> knots_;
  scene::Emission emission_;
  View view_;
  std::vector<CellShape> shapes_;
  std::vector<Cell> cells_;
};

}  // namespace tessera::reference
