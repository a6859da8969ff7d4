// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

namespace tessera::reference {

/// A part of a face as a separate Bernstein patch, over (a, b) in the unit square or triangle: control points as in
/// FacePatch, and the location of the part in the face.
struct FacePiece {
  bool triangle = false;
  int a_degree = 1, b_degree = 1;
  glm::dvec2 origin{0}, along_a{1, 0}, along_b{0, 1};  ///< in the face's (u, v)
  std::vector<glm::dvec3> control;
};

/// The control vectors of a piece's derivatives with respect to a and b.
struct PieceSlopes {
  std::vector<glm::dvec3> along_a, along_b;
};

PieceSlopes slopes(const FacePiece& piece);

/// Returns the two halves of a piece. A square is cut across its longer direction, a triangle from the middle of the
/// side b = 0 to the opposite corner, so that halves of halves keep their shape (newest-vertex bisection).
std::pair<FacePiece, FacePiece> halves(const FacePiece& piece);

/// The point of a patch at (a, b), with its derivatives.
struct PiecePoint {
  glm::dvec3 at, along_a, along_b;
};
PiecePoint point_of(const FacePiece& piece, glm::dvec2 place);

}  // namespace tessera::reference
