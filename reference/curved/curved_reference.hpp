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

/// Cells in VTK's form, of any order, with one scalar field.
///
/// Shape   Cell c has VTK's type types[c] and the nodes connectivity[offsets[c]] up to connectivity[offsets[c + 1]].
///         `degrees` are VTK's array HigherOrderDegrees: one entry per cell, or empty. Scalars: one per position or one
///         per cell.
struct CurvedCells {
  std::span<const std::uint8_t> types;
  std::span<const std::uint64_t> offsets;
  std::span<const std::uint32_t> connectivity;
  std::span<const glm::dvec3> positions;
  Association association = Association::point;
  std::span<const double> scalars;
  std::span<const std::array<int, 3>> degrees{};
};

/// An interval of one ray inside one cell, after clipping. A ray may pass through a curved cell several times.
struct CurvedSegment {
  double front, back;  ///< planar depth
  double length;       ///< world length along the ray
  std::size_t cell;
};

/// The slow, exact renderer of curved cells. It intersects every ray with the true faces of every cell whose box it
/// meets, and evaluates the field by isoparametric inversion along the ray. It does not subdivide the mesh, and shares
/// no code with the fast renderer except the plain values of scene/.
///
/// Cells    Point data: geometry and field by the type's shape functions (curved_shapes.hpp). So linear hexahedra,
///          wedges, pyramids and voxels are trilinear here, with curved faces and a field that is not linear, while
///          `Reference` is given tets. Cell data: constant in a cell. Cells without a volume are skipped.
/// Faces    curved_crossing.hpp intersects them with the ray; curved_inversion.hpp follows the ray between crossings.
/// Light    is computed from polynomials of the field along the ray (smooth_scalar.hpp) by curved_integral.hpp.
/// Order    (front, back, cell). Cells must not overlap or be folded: where the map from a cell's own coordinates to
///          space is not one-to-one, the result is finite but undefined, and may take up to a second.
/// Ties     have no rule: a ray exactly through an edge or a node, or along a face, may miss a segment, or count a
///          segment of negligible length twice. Rays at a small distance from the edge, node or face are correct.
/// Error    about 1e-12 in linear RGBA for cells of moderate shape; the error of inversion grows as cells become flat.
/// Cost     20 to 100 microseconds per cell that a ray meets, more if the ray nearly touches the cell.
class CurvedReference final : public RayReference {
 public:
  /// Copies the cells. Throws scene::Error(bad_input) for an invalid camera or size, an empty transfer function, a cell
  /// that does not match its type, an invalid index or array length, or numbers that are not finite.
  CurvedReference(const CurvedCells& cells, const scene::Camera& camera, scene::ImageSize size,
                  const scene::TransferFunction& transfer_function,
                  scene::Emission emission = scene::Emission::absorption);

  /// Returns the segments of the ray through pixel coordinates (x, y), front to back.
  [[nodiscard]] std::vector<CurvedSegment> segments(double x, double y) const;

  /// In the result, `length` is the total length of all segments, `segments` their number.
  [[nodiscard]] Pixel pixel(double x, double y) const override;
  [[nodiscard]] scene::ImageSize size() const override { return size_; }

 private:
  struct Cell {
    std::size_t shape;  ///< index in shapes_
    std::size_t index;  ///< index in the caller's mesh
    std::vector<glm::dvec3> control;
    std::vector<double> field;            ///< control values relative to `origin`; empty if the field is constant
    double origin, change;                ///< `change`: the largest of the control values
    double x_low, y_low, x_high, y_high;  ///< pixel coordinates outside which no ray meets the cell
  };
  /// A ray with two vectors across it; depths are planar.
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
  /// Returns the control points of a cell in a ray's frame; they are stored in `control`.
  [[nodiscard]] CellOnRay on_ray(const Cell& cell, const Frame& frame, std::vector<glm::dvec3>& control) const;
  /// Returns the cells that the ray meets, sorted. `controls` stores the cells' control points.
  [[nodiscard]] std::vector<Met> met(double x, double y, std::vector<std::vector<glm::dvec3>>& controls) const;

  scene::ImageSize size_;
  std::vector<scene::Knot> knots_;
  scene::Emission emission_;
  View view_;
  std::vector<CellShape> shapes_;
  std::vector<Cell> cells_;
};

}  // namespace tessera::reference
