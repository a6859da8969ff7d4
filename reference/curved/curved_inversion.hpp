// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "reference/curved/curved_crossing.hpp"
#include "reference/mesh/cell_on_ray.hpp"

namespace tessera::reference {

/// The path of a ray inside a cell, in the cell's own coordinates. Places are found by isoparametric inversion, which
/// starts at the nearest depth whose place is known.
class InnerPath {
 public:
  /// Creates the path from two crossings, and a place between them.
  InnerPath(const CellOnRay& cell, const Crossing& front, const Crossing& middle, const Crossing& back);

  /// Returns the place at a depth, which is clamped to the depths of the crossings.
  [[nodiscard]] glm::dvec3 place(double depth);

  [[nodiscard]] double front() const { return known_.begin()->first; }
  [[nodiscard]] double back() const { return known_.rbegin()->first; }
  [[nodiscard]] const CellOnRay& cell() const { return cell_; }
  BasisValues& room() { return room_; }

 private:
  /// Follows the ray from the place known at depth `from` to depth `to`. If a single step does not end in the domain,
  /// the step is halved. In a folded cell, where even that may fail, the function returns the last place after a few
  /// attempts.
  [[nodiscard]] glm::dvec3 follow(double from, glm::dvec3 place, double to, int halvings);

  CellOnRay cell_;
  std::map<double, glm::dvec3> known_;
  BasisValues room_;
  int failures_ = 0;
};

/// Returns the intervals of a ray inside a cell, front to back. Between two neighbouring crossings the ray is inside if
/// the point in the middle has a place in the domain. Newton's method searches for that place from the middle between
/// the crossings' places, from either of them along the ray, and from a lattice of places. `crossings` may be unordered
/// and contain duplicates.
std::vector<InnerPath> inner_paths(const CellOnRay& cell, std::vector<Crossing> crossings);

}  // namespace tessera::reference
