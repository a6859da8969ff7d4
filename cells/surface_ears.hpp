// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <random>
#include <span>
#include <vector>

#include "cells/face_triangles.hpp"

namespace tessera::cells {

/// Groups the triangles into parts. Triangles are in the same part if edges that exactly two triangles share connect
/// them.
std::vector<std::vector<CornerTriangle>> parts_on_edges(std::span<const CornerTriangle> triangles);

/// Cuts tets off a closed surface one by one, like ears of a polygon: each tet is inside the surface, has at least two
/// triangles of the surface, and does not contain any other part of the surface.
///
/// Limits   Not every surface has an ear (Schoenhardt's polyhedron does not), and cutting may lead to a surface without
///          ears. The total work on one surface over all attempts is bounded; after that no more ears are found.
class SurfaceEars {
 public:
  static constexpr std::size_t most_triangles = 200;

  /// Sets the surface. `triangles` are oriented outward, with corners `p`, which must outlive this object. Each number
  /// `attempt` selects another order of ears; 0 selects ears of the best shape first. Returns false if there are more
  /// than `most_triangles` triangles.
  bool set(std::span<const glm::dvec3> p, std::span<const CornerTriangle> triangles, std::uint32_t attempt);

  /// Cuts off the first ear. Returns false if there is none.
  bool cut(std::array<std::uint32_t, 4>& tet);

  /// The remaining triangles, oriented outward.
  [[nodiscard]] const std::vector<CornerTriangle>& left() const { return triangles_; }

 private:
  struct Edge {
    std::uint64_t corners;  ///< the corner with the smaller number first
    std::uint32_t triangle;
  };
  struct Ear {
    std::array<std::uint32_t, 4> corner;  ///< triangles 0 1 2 and 1 0 3 belong to the surface
    double rank;
  };
  void list();
  double rank_of(double quality, double edges, bool ends_a_corner);
  [[nodiscard]] bool is_free(const Ear& ear);
  [[nodiscard]] bool has_edge(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] std::ptrdiff_t find(const CornerTriangle& triangle) const;
  void take_off(const Ear& ear);

  std::span<const glm::dvec3> p_;
  std::vector<CornerTriangle> triangles_;
  std::vector<Edge> edges_;  ///< sorted
  std::vector<std::uint32_t> corners_;
  std::vector<Ear> ears_;
  std::size_t work_left_ = 0, cuts_left_ = 0;
  std::uint32_t attempt_ = 0;
  std::minstd_rand chance_;
};

}  // namespace tessera::cells
