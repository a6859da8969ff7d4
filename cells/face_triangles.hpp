// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace tessera::cells {

using CornerTriangle = std::array<std::uint32_t, 3>;

/// Cuts polygonal faces into triangles that depend only on the positions of the corners, not on which corner is listed
/// first or on the direction of the list, so that both cells of a face get the same triangles.
///
/// Convex       faces, planar or warped, become the fan from the lexicographically smallest corner, like the faces in
///              cell_split.hpp. The same applies to other faces that are completely visible from that corner.
/// Not convex   Ears are cut off, the one with the shortest cut first, as seen along the face's area vector.
/// Degenerate   Collinear corners are kept, if necessary in triangles without an area, so that no edge is lost.
/// Cost         is quadratic in the number of corners if ears are cut. Faces of more than `most_ears` corners
///              become fans whatever their shape.
class FaceCutter {
 public:
  static constexpr std::size_t most_ears = 512;

  /// Appends the triangles of a face, with the orientation of the face. Corners are numbered in the order of their
  /// positions `p`; no two consecutive corners are equal. Returns whether the triangles are a fan from the smallest
  /// corner.
  bool cut(std::span<const std::uint32_t> corners, std::span<const glm::dvec3> p,
           std::vector<CornerTriangle>& triangles);

 private:
  struct Ear {
    double cut = 0;  ///< squared length of the edge that cuts the corner off; infinity if it must not be cut off
    double turn = 0;
  };
  [[nodiscard]] Ear ear_at(std::size_t k, std::span<const glm::dvec3> p) const;
  [[nodiscard]] double turn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const;
  void cut_ears(std::span<const glm::dvec3> p);
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  std::vector<std::uint32_t> ring_, reversed_;  ///< the corners from the smallest on, in both directions; `ring_` is
                                                ///< the lexicographically smaller list
  std::vector<Ear> ears_;
  bool backwards_ = false;  ///< `ring_` has the opposite direction to the given list
  glm::dvec3 area_{0};      ///< twice the area vector of `ring_`
  double area_squared_ = 0;
  std::vector<CornerTriangle>* triangles_ = nullptr;
};

}  // namespace tessera::cells
