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

/// Allowed deviation of linear tets from a higher-order cell: position in world units, field in its own unit.
struct CurvedTolerance {
  double position = std::numeric_limits<double>::infinity();
  double field = std::numeric_limits<double>::infinity();
};

/// Bounds of the deviation. `field` is the error at a fixed point in space. It includes the first-order effect of the
/// position error: this error times the slopes of the cell's field at the tet's corners.
struct CurvedError {
  double position = 0, field = 0;
  void add(const CurvedError& other);
};

/// Estimated time for a tet of a cell with this lattice, relative to a tet of a quadratic or cubic tetrahedron. The
/// estimate is based on the number of coefficients.
double cost_of_tet(const CurvedLattice& lattice);

/// Divides higher-order cells into as few tets as are needed to keep position and field within a tolerance.
///
/// Method  A cell's corners give its initial tets, like those of a linear cell (cells/cell_split.hpp). Then edges are
///         halved as long as position or field on an edge deviates by more than the tolerance from the straight line;
///         of the six edges of a tet, the one with the largest deviation is halved first. A remaining deviation inside
///         a face or tet is reduced by an inner point. Deviations are bounded by the Bernstein coefficients on an edge,
///         a triangle or a tet.
/// Shared  The division of an edge or a face depends only on the nodes on it (CurvedCell), so neighbours divide shared
///         edges and faces in the same way, whatever the order of their nodes: there are no cracks.
/// Weights The deviation is a fraction, bounded by the coefficients of its numerator over the least coefficient of its
///         denominator. The slopes in CurvedError are then those of the numerator divided by that least coefficient.
/// Limits  Bounds are valid, up to rounding, for polynomials of a degree of 12 at most: tets up to order 12, hexahedra
///         up to 4, wedges up to 6; with weights one degree less. The functions of other cells, and those inside
///         pyramids, are approximated by interpolating polynomials. No edge is halved more than 20 times; a deviation
///         that remains is included in the error.
///
/// Source  Halving by edges, so that faces agree without comparing their tets: Ruprecht, Mueller, "A scheme for
///         edge-based adaptive tetrahedron subdivision" (Mathematical Visualization, 1998).
class CurvedSplitter {
 public:
  explicit CurvedSplitter(const CurvedTolerance& tolerance) : tolerance_(tolerance) {}

  /// Divides one cell. `positions` and `values` have an entry for each node of the lattice; without values the field is
  /// constant. `weights` are as in CurvedCell::set(). `first` contains the tets between the cell's corners, in the node
  /// numbers of the cell. Throws std::length_error for more than `limit` tets.
  void split(const CurvedLattice& lattice, std::span<const glm::dvec3> positions, std::span<const double> values,
             std::span<const double> weights, std::span<const scene::Tet> first, std::size_t limit);

  /// The tets of the last cell. Their corners are the corners of the cell, followed by the points in `added`, which
  /// have position and field.
  [[nodiscard]] std::span<const scene::Tet> tets() const { return tets_; }
  [[nodiscard]] std::size_t corners() const { return corners_; }
  [[nodiscard]] std::span<const glm::dvec4> added() const { return std::span(values_).subspan(corners_); }
  [[nodiscard]] const CurvedError& error() const { return error_; }

  /// Calls `report` for each of a cell's initial tets, with the deviation of its worst edge as a multiple of the
  /// tolerance. The reported number is larger than the deviation if the tet will need more tets than one of a
  /// polynomial cell.
  void tally_excess(const CurvedLattice& lattice, std::span<const glm::dvec3> positions, std::span<const double> values,
                    std::span<const double> weights, std::span<const scene::Tet> first,
                    const std::function<void(double excess)>& report);

 private:
  using Corners = std::span<const std::uint32_t>;
  struct Edge {
    float excess;                 ///< deviation as a multiple of the tolerance; edges above 1 are halved
    std::uint32_t middle = none;  ///< the midpoint, once the edge is halved
  };
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  void begin(const CurvedLattice& lattice, std::span<const glm::dvec3> positions, std::span<const double> values,
             std::span<const double> weights);
  Edge& edge(std::uint32_t a, std::uint32_t b);
  /// Returns the Bernstein coefficients of the deviation on a segment, triangle or tet.
  std::span<const glm::dvec4> departures(Corners corners);
  double least_weight(std::span<const CellPlace> places, unsigned faces, const BernsteinForm& form);
  /// Returns the coefficients of the deviation on a tet, computed from the tet's net.
  std::span<const glm::dvec4> net_departures(const scene::Tet& tet);
  void open(const scene::Tet& tet);
  /// Computes the coefficients of a tet from the cell's functions and stores them in tet_net_.
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
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> face_points_;  ///< the key is the face's sorted corners
  std::vector<scene::Tet> open_, tets_;
  int degree_ = 1;  ///< degree of the cell's functions, or of their approximation
  const BernsteinNet* net_ = nullptr;
  bool nets_are_exact_ = false;  ///< the coefficients of a half can be computed from those of the whole
  /// open_nets_ contains the coefficients of each open tet, one after the other, if they are exact; tet_net_ those of
  /// the current tet.
  std::vector<glm::dvec4> open_nets_, tet_net_;
  std::vector<glm::dvec4> samples_, coefficients_;
  std::vector<double> weight_samples_;
  CurvedError error_, tet_error_;  ///< errors of the cell's tets so far, and of the current tet
};

}  // namespace tessera::cells
