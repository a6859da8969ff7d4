// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cells/face_triangles.hpp"

namespace tessera::cells {

/// The faces of one polyhedron, cut into triangles that are oriented outward.
///
/// Corners      numbered in the order of their positions; coincident corners are merged.
/// Orientation  that of the faces if they are consistent, whether they point outward or inward; otherwise faces are
///              flipped to agree with their neighbours.
/// Closed       means that every edge is used equally often in both directions. More than two faces may share an edge.
class ClosedSurface {
 public:
  /// Sets the polyhedron. `faces` contains, for each face, the number of its corners, then the corners as indices of
  /// `positions`, which must be finite. Returns false if the faces do not form a closed surface. Takes n log n time.
  bool set(std::span<const std::uint32_t> faces, std::span<const glm::dvec3> positions);

  [[nodiscard]] const std::vector<glm::dvec3>& points() const { return points_; }
  /// For each corner, its index in `positions`: the smallest index of coincident positions.
  [[nodiscard]] const std::vector<std::uint32_t>& indices() const { return indices_; }
  /// The triangles, without those that have two coincident corners.
  [[nodiscard]] const std::vector<CornerTriangle>& triangles() const { return triangles_; }
  /// Six times the enclosed volume. Negative only for flat cells, by rounding.
  [[nodiscard]] double volume6() const { return volume6_; }
  /// Whether every face was cut into a fan from its smallest corner.
  [[nodiscard]] bool are_fans() const { return all_fans_; }
  /// Returns the corners in the order of VTK's hexahedron, if the polyhedron is a hexahedron and its faces are all
  /// fans.
  [[nodiscard]] std::optional<std::array<std::uint32_t, 8>> as_hexahedron() const;

 private:
  struct Edge {
    std::uint64_t corners;  ///< the corner with the smaller number first
    std::uint32_t face;
    bool forward;  ///< the face uses the edge from the smaller to the larger corner
  };
  void number_corners(std::span<const std::uint32_t> faces, std::span<const glm::dvec3> positions);
  void number_faces(std::span<const std::uint32_t> faces);
  void list_edges();
  [[nodiscard]] bool is_balanced() const;
  bool turn_faces();
  void cut_faces();
  std::uint32_t group_of(std::uint32_t face, bool& turned);
  [[nodiscard]] std::span<const std::uint32_t> face(std::size_t f) const {
    return std::span(face_corners_).subspan(face_starts_[f], face_starts_[f + 1] - face_starts_[f]);
  }
  [[nodiscard]] std::size_t face_count() const { return face_starts_.size() - 1; }

  std::vector<glm::dvec3> points_;
  std::vector<std::uint32_t> indices_;
  std::vector<CornerTriangle> triangles_;
  double volume6_ = 0;
  bool all_fans_ = false;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> numbers_;  ///< per index in `positions`: the corner's number
  std::vector<std::uint32_t> by_place_, face_corners_;
  std::vector<std::size_t> face_starts_;
  std::vector<Edge> edges_;            ///< sorted by their corners
  std::vector<std::uint8_t> turned_;   ///< per face: whether it was flipped
  std::vector<std::uint32_t> parent_;  ///< per face: its parent in the tree of faces that are oriented together
  std::vector<std::uint8_t> against_;  ///< per face: whether its orientation is opposite to that of its parent
  FaceCutter cutter_;
};

}  // namespace tessera::cells
