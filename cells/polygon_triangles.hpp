// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "cells/face_triangles.hpp"

namespace tessera::cells {

/// Cuts polygons, given by point indices, into triangles that depend only on the points' positions
/// (face_triangles.hpp).
class PolygonTriangles {
 public:
  /// Appends the triangles of a polygon; nothing if its corners have fewer than three distinct positions.
  void cut(std::span<const std::uint32_t> polygon, std::span<const glm::dvec3> points,
           std::vector<std::array<std::uint32_t, 3>>& triangles);

 private:
  std::vector<std::uint32_t> ring_, sorted_, corners_;
  std::vector<glm::dvec3> places_;
  std::vector<CornerTriangle> triangles_;
  FaceCutter cutter_;
};

}  // namespace tessera::cells
