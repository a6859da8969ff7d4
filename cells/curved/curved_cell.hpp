// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "cells/curved/curved_lattice.hpp"

namespace tessera::cells {

/// A place in a cell: (r, s, t) in units of 2^-20. In these units midpoints are exact, and the same point has exact
/// coordinates in a neighbouring cell, too.
using CellPlace = std::array<std::int32_t, 3>;
inline constexpr std::int32_t cell_unit = 1 << 20;

/// One higher-order cell: evaluates position and field at any place in the cell.
///
/// Functions  The cell is isoparametric: position and field use the same functions, Lagrange's on the lattice's nodes.
///            Missing nodes of serendipity cells are first computed from their polynomials. A node in the middle of a
///            triangle adds a function that is 0 on the edges, and a node inside the cell adds one that is 0 on the
///            faces. Nodes of Bezier cells are Bernstein coefficients; with weights, position and field are weighted
///            sums divided by the sum of weights. Pyramids have other functions (cells/curved/curved_pyramid.hpp).
/// Shared     A place on a face or edge is computed from the nodes of that face or edge alone, in an order that depends
///            on the corners' positions. So both cells at a face get the same bits, however the cells are numbered.
class CurvedCell {
 public:
  /// Sets the next cell. `positions` and `values` have an entry for each of the lattice's `given` nodes; without values
  /// the field is 0. Weights of Bezier cells must be positive; without weights, all are 1. The lattice must outlive the
  /// use of the cell.
  void set(const CurvedLattice& lattice, std::span<const glm::dvec3> positions, std::span<const double> values,
           std::span<const double> weights = {});

  /// Returns a bit for each face that contains a corner. The bits of a point added between other points are the bits
  /// that all of these points have in common.
  [[nodiscard]] unsigned faces_of_corner(std::size_t corner) const { return corner_faces_[corner]; }
  [[nodiscard]] CellPlace place_of_corner(std::size_t corner) const;

  /// Returns position and field at a place that is on all of `faces`.
  [[nodiscard]] glm::dvec4 at(const CellPlace& place, unsigned faces);

  /// Sorts the corners of a segment, triangle or tetrahedron that is on all of `faces`. Both cells at a face compute
  /// the same order.
  void order(std::span<CellPlace> corners, unsigned faces);

  /// Returns the degree of position and field on a straight segment, triangle or tetrahedron that is on all of `faces`.
  /// With weights, it is the degree of the product of position or field, weights and a linear function.
  [[nodiscard]] int degree_on(unsigned faces);

  [[nodiscard]] bool has_weights() const { return !weights_.empty(); }
  /// Smallest weight of all nodes, which is a lower bound of the weight at any place.
  [[nodiscard]] double least_weight() const { return least_weight_; }
  /// Whether the cell's functions are polynomials, whose degree is degree_on(0).
  [[nodiscard]] bool is_polynomial() const { return lattice_->family != CurvedFamily::pyramid && !has_weights(); }

  struct Weighted {
    glm::dvec4 value;  ///< position and field
    double weight;     ///< the divisor of the sums; 1 without weights
  };
  /// Returns the value at the place sum of weights[k] corners[k] / total, for corners sorted by `order`.
  [[nodiscard]] Weighted between(std::span<const CellPlace> corners, std::span<const int> weights, int total,
                                 unsigned faces);

 private:
  /// The part of the cell on some of its faces: an edge, a face, or the cell itself.
  struct Part {
    CellPlace origin{};            ///< origin of the part's own coordinates
    std::array<int, 2> axis{};     ///< axes of the cell that determine the coordinates in the part
    std::array<int, 4> inverse{};  ///< matrix from these two cell coordinates to part coordinates; all integers
    bool triangle = false;
    int dimensions = 0;
    std::array<int, 2> order{};
    std::vector<glm::dvec4> nodes, weights;  ///< nodes on the part's lattice; weights in x, or empty
    bool has_bubble = false;
    glm::dvec4 bubble{};
  };

  const Part& part_on(unsigned faces);
  void make_edge(unsigned faces, Part& part) const;
  void make_face(unsigned faces, Part& part) const;
  void add_to(Part& part, const LatticePlace& place) const;
  static void face_to_values(Part& part);
  void add_missing_nodes();
  void add_missing_on(const CellFace& face, const std::vector<bool>& given);
  void add_missing_inside(const std::vector<bool>& given);
  void make_inside();
  void make_bubbles();
  [[nodiscard]] glm::dvec4& node(const LatticePlace& p) { return values_[static_cast<std::size_t>(lattice_->slot(p))]; }
  [[nodiscard]] const glm::dvec4& node(const LatticePlace& p) const {
    return values_[static_cast<std::size_t>(lattice_->slot(p))];
  }
  [[nodiscard]] LatticePlace lattice_corner(std::size_t corner) const;
  [[nodiscard]] bool before(std::size_t corner, std::size_t other) const;
  /// Returns the smallest corner of a face by position, and its two neighbours, the smaller first.
  [[nodiscard]] std::array<std::size_t, 3> first_corners(const CellFace& face) const;
  /// Converts a place to coordinates in the part, in units of 2^-20; for the cell itself they do not change.
  [[nodiscard]] static std::array<std::int32_t, 3> coordinates(const Part& part, const CellPlace& place);
  [[nodiscard]] glm::dvec4 evaluate(const Part& part, const std::array<double, 3>& x) const;
  [[nodiscard]] double weight(const Part& part, const std::array<double, 3>& x) const;
  [[nodiscard]] glm::dvec4 sum_of(const Part& part, std::span<const glm::dvec4> nodes,
                                  const std::array<double, 3>& x) const;
  [[nodiscard]] glm::dvec4 sum_inside(std::span<const glm::dvec4> nodes, const std::array<double, 3>& x) const;

  const CurvedLattice* lattice_ = nullptr;
  std::vector<glm::dvec4> values_;   ///< at the lattice's places, then at other nodes; premultiplied by the weights
  std::vector<glm::dvec4> weights_;  ///< weights in x, in the order of values_; or empty
  std::vector<glm::dvec4> inside_, inside_weights_;  ///< operands of sum_inside()
  std::array<glm::dvec4, 5> bubbles_{};              ///< coefficients for the cell's triangles, then for the inside
  double least_weight_ = 1;
  std::vector<unsigned> corner_faces_;
  std::array<glm::dvec3, 8> corner_position_;
  std::vector<std::pair<unsigned, Part>> parts_;  ///< the parts requested so far; the key is their set of faces
  std::size_t parts_made_ = 0;                    ///< number of entries used for this cell; the memory of the others is
                                                  ///< reused
};

}  // namespace tessera::cells
