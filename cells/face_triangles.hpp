// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace tessera::cells {

using CornerTriangle = std::array<std::uint32_t, 3>;

/// Cuts polygonal faces into triangles that depend on the positions of the corners alone: not on where the list of
/// corners starts nor on which way round it goes, so that both cells of a face have the same ones.
///
/// Convex       planar or warped: the fan from the lexicographically smallest corner, as cell_split.hpp cuts faces. So
///              are faces that can be seen whole from there.
/// Not convex   ears are cut off, the one with the shortest cut first, as seen along the face's area vector.
/// Degenerate   collinear corners stay, in triangles without an area if need be, so that no edge is lost.
/// Cost         corners squared where ears are cut; faces of more than `most_ears` corners are fans whatever their
///              shape.
class FaceCutter {
 public:
  static constexpr std::size_t most_ears = 512;

  /// Appends the triangles of a face, turning as its corners do. Corners are numbers in the order of their positions
  /// `p`; none is the same as the next. Returns whether the triangles are a fan from the smallest.
  bool cut(std::span<const std::uint32_t> corners, std::span<const glm::dvec3> p,
           std::vector<CornerTriangle>& triangles);

 private:
  struct Ear {
    double cut = 0;  ///< length squared of what cuts it off; infinity if nothing may
    double turn = 0;
  };
  [[nodiscard]] Ear ear_at(std::size_t k, std::span<const glm::dvec3> p) const;
  [[nodiscard]] double turn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const;
  void cut_ears(std::span<const glm::dvec3> p);
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  std::vector<std::uint32_t> ring_, other_way_;  ///< the corners from the smallest on, the smaller neighbour next
  std::vector<Ear> ears_;
  bool backwards_ = false;  ///< `ring_` goes round against the given list
  glm::dvec3 area_{0};      ///< twice the area vector of `ring_`
  double area_squared_ = 0;
  std::vector<CornerTriangle>* triangles_ = nullptr;
};

}  // namespace tessera::cells
