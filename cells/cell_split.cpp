// SPDX-License-Identifier: BSD-3-Clause
#include "cells/cell_split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "scene/position_order.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::cells {
namespace {

// Faces in VTK's corner numbering (vtkHexahedron.h, vtkWedge.h, ...). In VTK the base of the wedge is oriented outward,
// the base of the others inward.
constexpr CellFace tet_faces[] = {{3, {0, 2, 1}}, {3, {0, 1, 3}}, {3, {1, 2, 3}}, {3, {0, 3, 2}}};
constexpr CellFace hexahedron_faces[] = {{4, {0, 3, 2, 1}}, {4, {4, 5, 6, 7}}, {4, {0, 1, 5, 4}},
                                         {4, {1, 2, 6, 5}}, {4, {2, 3, 7, 6}}, {4, {0, 4, 7, 3}}};
constexpr CellFace wedge_faces[] = {
    {3, {0, 1, 2}}, {3, {3, 5, 4}}, {4, {0, 3, 4, 1}}, {4, {1, 4, 5, 2}}, {4, {2, 5, 3, 0}}};
constexpr CellFace pyramid_faces[] = {
    {4, {0, 3, 2, 1}}, {3, {0, 1, 4}}, {3, {1, 2, 4}}, {3, {2, 3, 4}}, {3, {3, 0, 4}}};
constexpr CellFace pentagonal_prism_faces[] = {{5, {0, 4, 3, 2, 1}}, {5, {5, 6, 7, 8, 9}}, {4, {0, 1, 6, 5}},
                                               {4, {1, 2, 7, 6}},    {4, {2, 3, 8, 7}},    {4, {3, 4, 9, 8}},
                                               {4, {4, 0, 5, 9}}};
constexpr CellFace hexagonal_prism_faces[] = {{6, {0, 5, 4, 3, 2, 1}}, {6, {6, 7, 8, 9, 10, 11}}, {4, {0, 1, 7, 6}},
                                              {4, {1, 2, 8, 7}},       {4, {2, 3, 9, 8}},         {4, {3, 4, 10, 9}},
                                              {4, {4, 5, 11, 10}},     {4, {5, 0, 6, 11}}};

// A voxel numbers its corners x first, then y, then z.
constexpr std::array<std::uint8_t, 8> voxel_order = {0, 1, 3, 2, 4, 5, 7, 6};

/// Total order of the corners of a cell: by position, and for coincident corners by their index in the cell.
struct CornerOrder {
  std::array<glm::dvec3, 12> p;

  bool operator()(std::uint8_t a, std::uint8_t b) const { return p[a] != p[b] ? scene::is_before(p[a], p[b]) : a < b; }
};

using Triangle = std::array<std::uint8_t, 3>;

/// Up to 12 tets of one cell, in the corner numbers of the cell.
struct LocalTets {
  std::array<std::array<std::uint8_t, 4>, 12> tet;
  int count = 0;
  void push_back(const std::array<std::uint8_t, 4>& t) { tet[count++] = t; }
};

/// Collects the triangles, oriented outward, of all faces that do not contain `apex`. Returns their number.
int far_triangles(std::span<const CellFace> faces, std::uint8_t apex, const CornerOrder& less,
                  std::array<Triangle, 12>& triangles) {
  int count = 0;
  for (const CellFace& face : faces) {
    const auto begin = face.corner.begin(), end = begin + face.size;
    if (std::find(begin, end, apex) != end) continue;
    const auto start = static_cast<int>(std::min_element(begin, end, less) - begin);
    for (int k = 1; k + 1 < face.size; ++k)
      triangles[count++] = {face.corner[start], face.corner[(start + k) % face.size],
                            face.corner[(start + k + 1) % face.size]};
  }
  return count;
}

/// For each corner of a hexahedron, the corner that does not share a face with it.
constexpr std::array<std::uint8_t, 8> opposite_in_hexahedron = {6, 7, 4, 5, 2, 3, 0, 1};

/// If no cut of a face meets the corner `far`, the three triangles around the corner are a cap that one tet cuts off,
/// which gives 5 tets in total.
bool split_off_far_corner(std::uint8_t apex, std::span<const Triangle> triangles, LocalTets& local) {
  const std::uint8_t far = opposite_in_hexahedron[apex];
  std::array<Triangle, 3> cap;
  int touching = 0;
  for (const Triangle& triangle : triangles) {
    if (std::find(triangle.begin(), triangle.end(), far) == triangle.end()) continue;
    if (touching == 3) return false;
    cap[touching++] = triangle;
  }
  if (touching != 3) return false;
  for (const Triangle& triangle : triangles)
    if (std::find(triangle.begin(), triangle.end(), far) == triangle.end())
      local.push_back({triangle[0], triangle[1], triangle[2], apex});
  std::rotate(cap[0].begin(), std::find(cap[0].begin(), cap[0].end(), far), cap[0].end());
  const std::uint8_t p = cap[0][1], q = cap[0][2];
  const std::uint8_t r = *std::find_if(cap[1].begin(), cap[1].end(), [&](std::uint8_t c) {
    return c != far && c != p && c != q;  // cap[1] contains `far` and one of p, q
  });
  local.push_back({far, p, q, r});
  local.push_back({p, q, r, apex});
  return true;
}

}  // namespace

CellShape cell_shape(std::uint8_t vtk_type) {
  const CellType type{vtk_type};
  switch (type) {
    case CellType::tetra:
      return {CellKind::tet, 4, 4, false};
    case CellType::voxel:
      return {CellKind::voxel, 8, 8, false};
    case CellType::hexahedron:
      return {CellKind::hexahedron, 8, 8, false};
    case CellType::wedge:
      return {CellKind::wedge, 6, 6, false};
    case CellType::pyramid:
      return {CellKind::pyramid, 5, 5, false};
    case CellType::pentagonal_prism:
      return {CellKind::pentagonal_prism, 10, 10, false};
    case CellType::hexagonal_prism:
      return {CellKind::hexagonal_prism, 12, 12, false};
    case CellType::convex_point_set:
      return {CellKind::convex_point_set, 0, 0, false};
    case CellType::polyhedron:
      return {CellKind::polyhedron, 0, 0, false};
    case CellType::quadratic_tetra:
      return {CellKind::tet, 4, 10, true};
    case CellType::quadratic_hexahedron:
      return {CellKind::hexahedron, 8, 20, true};
    case CellType::quadratic_wedge:
      return {CellKind::wedge, 6, 15, true};
    case CellType::quadratic_pyramid:
      return {CellKind::pyramid, 5, 13, true};
    case CellType::triquadratic_hexahedron:
      return {CellKind::hexahedron, 8, 27, true};
    case CellType::quadratic_linear_wedge:
      return {CellKind::wedge, 6, 12, true};
    case CellType::biquadratic_quadratic_wedge:
      return {CellKind::wedge, 6, 18, true};
    case CellType::biquadratic_quadratic_hexahedron:
      return {CellKind::hexahedron, 8, 24, true};
    case CellType::triquadratic_pyramid:
      return {CellKind::pyramid, 5, 19, true};
    case CellType::lagrange_tetrahedron:
    case CellType::bezier_tetrahedron:
      return {CellKind::tet, 4, 0, true};
    case CellType::lagrange_hexahedron:
    case CellType::bezier_hexahedron:
      return {CellKind::hexahedron, 8, 0, true};
    case CellType::lagrange_wedge:
    case CellType::bezier_wedge:
      return {CellKind::wedge, 6, 0, true};
    case CellType::lagrange_pyramid:
    case CellType::bezier_pyramid:
      return {CellKind::pyramid, 5, 0, true};
    default:
      break;
  }
  // The last two ranges contain VTK's parametric and its older higher-order curves and surfaces.
  const bool flat = type <= CellType::quad || (type >= CellType::quadratic_edge && type <= CellType::quadratic_quad) ||
                    type == CellType::biquadratic_quad || type == CellType::quadratic_linear_quad ||
                    (type >= CellType::biquadratic_triangle && type <= CellType::quadratic_polygon) ||
                    (type >= CellType::lagrange_curve && type <= CellType::lagrange_quadrilateral) ||
                    (type >= CellType::bezier_curve && type <= CellType::bezier_quadrilateral) ||
                    (vtk_type >= 51 && vtk_type <= 54) || (vtk_type >= 60 && vtk_type <= 63);
  return {flat ? CellKind::not_volumetric : CellKind::unsupported, 0, 0, false};
}

std::string cell_type_name(std::uint8_t vtk_type) {
  if (vtk_type == vtk_number(CellType::convex_point_set)) return "convex point set";
  if (vtk_type == vtk_number(CellType::polyhedron)) return "polyhedron";
  const CellShape shape = cell_shape(vtk_type);
  static constexpr const char* names[] = {"tetrahedron",      "voxel",           "hexahedron",  "wedge", "pyramid",
                                          "pentagonal prism", "hexagonal prism", "face or line"};
  if (shape.kind == CellKind::unsupported) return fmt::format("cell of VTK type {}", vtk_type);
  return fmt::format("{}{}", shape.higher_order ? "higher-order " : "", names[static_cast<int>(shape.kind)]);
}

std::span<const CellFace> faces_of(CellKind kind) {
  switch (kind) {
    case CellKind::tet:
      return tet_faces;
    case CellKind::voxel:
    case CellKind::hexahedron:
      return hexahedron_faces;
    case CellKind::wedge:
      return wedge_faces;
    case CellKind::pyramid:
      return pyramid_faces;
    case CellKind::pentagonal_prism:
      return pentagonal_prism_faces;
    case CellKind::hexagonal_prism:
      return hexagonal_prism_faces;
    default:
      return {};
  }
}

void append_faces(CellKind kind, std::span<const std::uint32_t> corner, std::vector<std::uint32_t>& faces) {
  if (kind == CellKind::tet) return;
  for (const CellFace& face : faces_of(kind)) {
    faces.push_back(static_cast<std::uint32_t>(face.size));
    for (int k = 0; k < face.size; ++k)
      faces.push_back(corner[kind == CellKind::voxel ? voxel_order[face.corner[k]] : face.corner[k]]);
  }
}

void split_cell(CellKind kind, std::span<const std::uint32_t> corner, std::span<const glm::dvec3> positions,
                std::vector<scene::Tet>& tets) {
  if (kind == CellKind::tet) {
    tets.push_back({corner[0], corner[1], corner[2], corner[3]});
    return;
  }
  std::array<std::uint32_t, 12> id{};
  CornerOrder less{};
  const int corners = static_cast<int>(corner.size());
  for (int k = 0; k < corners; ++k) {
    id[k] = corner[kind == CellKind::voxel ? voxel_order[k] : k];
    less.p[k] = positions[id[k]];
  }
  std::uint8_t apex = 0;
  for (int k = 1; k < corners; ++k)
    if (less(static_cast<std::uint8_t>(k), apex)) apex = static_cast<std::uint8_t>(k);

  std::array<Triangle, 12> triangles;
  const auto count = static_cast<std::size_t>(far_triangles(faces_of(kind), apex, less, triangles));
  const std::span<const Triangle> far(triangles.data(), count);
  LocalTets local;
  if (corners != 8 || !split_off_far_corner(apex, far, local))
    for (const Triangle& t : far) local.push_back({t[0], t[1], t[2], apex});
  for (int k = 0; k < local.count; ++k) {
    const auto& t = local.tet[k];
    tets.push_back({id[t[0]], id[t[1]], id[t[2]], id[t[3]]});
  }
}

}  // namespace tessera::cells
