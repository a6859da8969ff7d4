// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "cells/curved/bernstein.hpp"
#include "cells/curved/curved_cell.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::cells {

/// How far linear tets may be from a higher-order cell: in position, world units, and in the field's own unit.
struct CurvedTolerance {
  double position = std::numeric_limits<double>::infinity();
  double field = std::numeric_limits<double>::infinity();
};

/// Bounds on how far they are. `field` is at one place in space: what position is off counts for it too, to first
/// order, by the cell's slopes at the tet's corners.
struct CurvedError {
  double position = 0, field = 0;
  void add(const CurvedError& other);
};

/// How many times as long a tet of such a cell takes as one of a quadratic or cubic tetrahedron, by its coefficients.
double cost_of_tet(const CurvedLattice& lattice);

/// Divides higher-order cells into tets, as few as keep position and field within a tolerance.
///
/// Method  A cell's corners give its first tets, as those of a linear cell (cells/cell_split.hpp). Then edges are
/// halved,
///         the worst of a tet's six first, as long as position or field on one departs by more than the tolerance from
///         the straight line; then what is left inside a face or tet is divided about a point in it. What is off is
///         bounded by the coefficients of Bernstein's form, of an edge, a triangle or a tet.
/// Shared  What becomes of an edge or a face follows from the nodes on it alone (CurvedCell), so neighbours divide what
///         they share alike, whatever order their nodes come in: there are no cracks.
/// Weights What is off is a fraction: the coefficients of its numerator, over the least of its denominator's, bound it.
///         The slopes that CurvedError counts are then those of a numerator over that one number.
/// Limits  Bounds hold to rounding for polynomials of a degree of 12 at most: tets up to order 12, hexahedra up to 4,
///         wedges up to 6; with weights one degree less. Others, and pyramids inside, are as near as a polynomial
///         through points is. No edge is halved more than 20 times; what is left then is in the error.
///
/// Source  Halving by edges, so that faces agree without their tets being looked at: Ruprecht, Mueller, "A scheme for
///         edge-based adaptive tetrahedron subdivision" (Mathematical Visualization, 1998).
class CurvedSplitter {
 public:
  explicit CurvedSplitter(const CurvedTolerance& tolerance) : tolerance_(tolerance) {}

  /// Divides one cell, of as many positions and values as the lattice has nodes; no values: the field is one number.
  /// Weights as CurvedCell::set() has them.
  /// `first` are the tets of its corners, numbered as in the cell. Throws std::length_error for more than `limit` tets.
  void split(const CurvedLattice& lattice, std::span<const glm::dvec3> positions, std::span<const double> values,
             std::span<const double> weights, std::span<const scene::Tet> first, std::size_t limit);

  /// Of the last cell: tets in corner numbers, and from the number of corners on in `added`, position and field.
  [[nodiscard]] std::span<const scene::Tet> tets() const { return tets_; }
  [[nodiscard]] std::size_t corners() const { return corners_; }
  [[nodiscard]] std::span<const glm::dvec4> added() const { return std::span(values_).subspan(corners_); }
  [[nodiscard]] const CurvedError& error() const { return error_; }

  /// Says of each of a cell's first tets how far its worst edge is off, in tolerances; more where it will take
  /// more tets than one of a polynomial.
  void tally_excess(const CurvedLattice& lattice, std::span<const glm::dvec3> positions, std::span<const double> values,
                    std::span<const double> weights, std::span<const scene::Tet> first,
                    const std::function<void(double excess)>& say);

 private:
  using Corners = std::span<const std::uint32_t>;
  struct Edge {
    float excess;                 ///< how far it is off, in tolerances; halved if over 1
    std::uint32_t middle = none;  ///< its point, once it is halved
  };
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  void begin(const CurvedLattice& lattice, std::span<const glm::dvec3> positions, std::span<const double> values,
             std::span<const double> weights);
  Edge& edge(std::uint32_t a, std::uint32_t b);
  /// Bernstein's coefficients of what is off on a segment, triangle or tet.
  std::span<const glm::dvec4> departures(Corners corners);
  double least_weight(std::span<const CellPlace> places, unsigned faces, const BernsteinForm& form);
  /// Those of a tet, from its net.
  std::span<const glm::dvec4> net_departures(const scene::Tet& tet);
  void open(const scene::Tet& tet);
  /// The coefficients of a tet, from the cell's functions: tet_net_.
  void make_net(const scene::Tet& tet);
  [[nodiscard]] glm::dvec3 gradient_at(std::size_t corner) const;
  [[nodiscard]] double excess_of(std::span<const glm::dvec4> departures) const;
  [[nodiscard]] unsigned faces_on(Corners corners) const;
  bool halve_worst_edge(const scene::Tet& tet);
  bool divide_worst_face(const scene::Tet& tet);
  std::uint32_t add_point(const CellPlace& place, unsigned faces);
  std::uint32_t point_within(Corners corners);
  [[nodiscard]] bool before(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] CurvedError error_of(std::span<const glm::dvec4> departures) const;

  CurvedTolerance tolerance_;
  CurvedCell cell_;
  std::size_t corners_ = 0;
  std::vector<CellPlace> places_;
  std::vector<unsigned> faces_;
  std::vector<glm::dvec4> values_;
  std::unordered_map<std::uint64_t, Edge> edges_;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> face_points_;  ///< within faces, by their corners in order
  std::vector<scene::Tet> open_, tets_;
  int degree_ = 1;  ///< of the cell, or of what stands for its functions
  const BernsteinNet* net_ = nullptr;
  bool nets_are_exact_ = false;  ///< a half's coefficients follow from the whole's
  /// Each open tet's coefficients, one after the other, where they are exact; those of the tet at hand.
  std::vector<glm::dvec4> open_nets_, tet_net_;
  std::vector<glm::dvec4> samples_, coefficients_;
  std::vector<double> weight_samples_;
  CurvedError error_, tet_error_;  ///< of the cell's tets so far, and of the one at hand
};

}  // namespace tessera::cells
