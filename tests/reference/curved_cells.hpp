// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "reference/curved/curved_reference.hpp"
#include "reference/curved/curved_shapes.hpp"

/// Cells of every type, created from maps of their own coordinates to space.
namespace tessera::reference {

/// A cell type with its numbers.
struct TypeCase {
  std::string name;
  std::uint8_t type;
  std::size_t nodes;
  std::array<int, 3> orders{0, 0, 0};
  int degree;            ///< complete to this degree in the cell's own coordinates (for a pyramid: in its true ones)
  bool bezier = false;   ///< nodes are control points
  bool pyramid = false;  ///< its own coordinates are those of a collapsed box

  [[nodiscard]] CellShape shape() const { return cell_shape(type, nodes, orders, "test"); }
};

inline std::vector<TypeCase> all_types() {
  std::vector<TypeCase> types{
      {"tet", 10, 4, {}, 1},
      {"voxel", 11, 8, {}, 1},
      {"hexahedron", 12, 8, {}, 1},
      {"wedge", 13, 6, {}, 1},
      {"pyramid", 14, 5, {}, 1, false, true},
      {"quadratic tet", 24, 10, {}, 2},
      {"quadratic hexahedron", 25, 20, {}, 2},
      {"quadratic wedge", 26, 15, {}, 2},
      {"quadratic pyramid", 27, 13, {}, 1, false, true},
      {"triquadratic hexahedron", 29, 27, {}, 2},
      {"quadratic-linear wedge", 31, 12, {}, 1},
      {"biquadratic-quadratic wedge", 32, 18, {}, 2},
      {"biquadratic-quadratic hexahedron", 33, 24, {}, 2},
      {"triquadratic pyramid", 37, 19, {}, 2, false, true},
      {"enriched Lagrange tet", 71, 15, {}, 2},
      {"enriched Lagrange wedge", 73, 21, {}, 2},
      {"Lagrange hexahedron 3, 2, 4", 72, 60, {3, 2, 4}, 2},
      {"Lagrange wedge 3, 3, 2", 73, 30, {3, 3, 2}, 2},
      {"Lagrange wedge 2, 2, 4", 73, 30, {2, 2, 4}, 2},
  };
  for (int n = 1; n <= 5; ++n) {
    const auto order = std::to_string(n);
    const auto a = static_cast<std::size_t>(n) + 1;
    types.push_back({"Lagrange tet " + order, 71, a * (a + 1) * (a + 2) / 6, {}, n});
    types.push_back({"Lagrange wedge " + order, 73, a * a * (a + 1) / 2, {}, n});
    if (n < 5) types.push_back({"Lagrange hexahedron " + order, 72, a * a * a, {}, n});
  }
  for (const int n : {1, 2, 3, 4}) {
    const auto a = static_cast<std::size_t>(n) + 1;
    types.push_back({"Lagrange pyramid " + std::to_string(n), 74, a * (a + 1) * (2 * a + 1) / 6, {}, n, false, true});
  }
  for (const int n : {2, 3}) {
    const auto order = std::to_string(n);
    const auto a = static_cast<std::size_t>(n) + 1;
    types.push_back({"Bezier tet " + order, 78, a * (a + 1) * (a + 2) / 6, {}, n, true});
    types.push_back({"Bezier hexahedron " + order, 79, a * a * a, {}, n, true});
    types.push_back({"Bezier wedge " + order, 80, a * a * (a + 1) / 2, {}, n, true});
  }
  return types;
}

/// Converts a place in the cell's coordinates to coordinates in which the cell is a polytope. A pyramid then has the
/// unit square as base and the apex (1/2, 1/2, 1).
inline glm::dvec3 polytope_place(const TypeCase& type, const glm::dvec3& place) {
  if (!type.pyramid) return place;
  return {0.5 + (place.x - 0.5) * (1 - place.z), 0.5 + (place.y - 0.5) * (1 - place.z), place.z};
}

using Map = std::function<glm::dvec3(const glm::dvec3&)>;
using Scalar = std::function<double(const glm::dvec3&)>;

/// Cells that own their arrays.
struct CurvedMesh {
  std::vector<std::uint8_t> types;
  std::vector<std::uint64_t> offsets{0};
  std::vector<std::uint32_t> connectivity;
  std::vector<glm::dvec3> positions;
  std::vector<double> scalars;
  std::vector<std::array<int, 3>> degrees;
  Association association = Association::point;

  [[nodiscard]] CurvedCells cells() const {
    return {types, offsets, connectivity, positions, association, scalars, degrees};
  }

  /// A cell with its own points at `points`.
  void add(std::uint8_t type, const std::array<int, 3>& orders, const std::vector<glm::dvec3>& points) {
    for (const glm::dvec3& p : points) {
      connectivity.push_back(static_cast<std::uint32_t>(positions.size()));
      positions.push_back(p);
    }
    types.push_back(type);
    degrees.push_back(orders);
    offsets.push_back(connectivity.size());
  }

  /// A cell with nodes where `map` maps their places (in coordinates in which it is a polytope), with the field
  /// `scalar` of these places. For Bezier cells this does not compute control points: only linear maps and fields fit
  /// them.
  void add(const TypeCase& type, const Map& map, const Scalar& scalar) {
    std::vector<glm::dvec3> points;
    for (const glm::dvec3& place : type.shape().nodes) {
      points.push_back(map(polytope_place(type, place)));
      scalars.push_back(scalar(polytope_place(type, place)));
    }
    add(type.type, type.orders, points);
  }
};

}  // namespace tessera::reference
