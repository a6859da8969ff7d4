// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/boundary_faces.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <limits>
#include <tuple>

#include "exchange/collectives.hpp"

namespace tessera::frame {
namespace {

/// A face in a message, with its corners sorted by position.
struct OpenFace {
  std::array<glm::dvec3, 3> corners;
  std::array<double, 3> values;
  std::uint32_t turned;  ///< 1: the face points outward in the order of corners 0, 2, 1
  std::uint32_t rank;
};
static_assert(sizeof(OpenFace) == 104);

auto place(const glm::dvec3& p) { return std::tuple(p.x, p.y, p.z); }

/// Returns the number of each point in the order of positions. Coincident points have the same number.
std::vector<std::uint32_t> numbers_by_place(const scene::TetMeshView& mesh) {
  std::vector<std::uint32_t> order;
  {
    std::vector<std::uint8_t> used(mesh.positions.size(), 0);
    for (const scene::Tet& tet : mesh.tets)
      for (const std::uint32_t v : tet) used[v] = 1;
    for (std::uint32_t v = 0; v < used.size(); ++v)
      if (used[v] != 0) order.push_back(v);
  }
  tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return place(mesh.positions[a]) < place(mesh.positions[b]);
  });
  std::vector<std::uint32_t> numbers(mesh.positions.size(), 0);
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && mesh.positions[order[i]] != mesh.positions[order[i - 1]]) ++number;
    numbers[order[i]] = number;
  }
  return numbers;
}

struct TetFace {
  std::array<std::uint32_t, 3> points;  ///< numbers by position, ascending
  std::uint32_t tet, opposite;
};

OpenFace open_face(const scene::TetMeshView& mesh, const std::vector<std::uint32_t>& numbers, const TetFace& face) {
  const scene::Tet& tet = mesh.tets[face.tet];
  OpenFace open{};
  std::array<std::uint32_t, 3> corners{};
  std::copy_if(tet.begin(), tet.end(), corners.begin(),
               [&, i = 0u](std::uint32_t) mutable { return i++ != face.opposite; });
  std::ranges::sort(corners, {}, [&](std::uint32_t v) { return numbers[v]; });
  const bool per_cell = mesh.association == scene::Association::cell;
  for (std::size_t i = 0; i < 3; ++i) {
    open.corners[i] = mesh.positions[corners[i]];
    open.values[i] = mesh.scalars[per_cell ? face.tet : corners[i]];
  }
  const glm::dvec3 a = open.corners[1] - open.corners[0], b = open.corners[2] - open.corners[0];
  const glm::dvec3 inward = mesh.positions[tet[face.opposite]] - open.corners[0];
  open.turned = glm::dot(glm::cross(a, b), inward) > 0 ? 1 : 0;
  return open;
}

/// Returns the faces that belong to only one tet of this part, sorted by the positions of their corners. Faces without
/// area are left out.
std::vector<OpenFace> open_faces(const scene::TetMeshView& mesh) {
  const std::vector<std::uint32_t> numbers = numbers_by_place(mesh);
  std::vector<TetFace> faces;
  faces.reserve(4 * mesh.tets.size());
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t)
    for (std::uint32_t opposite = 0; opposite < 4; ++opposite) {
      TetFace face{{}, t, opposite};
      for (std::uint32_t i = 0, k = 0; i < 4; ++i)
        if (i != opposite) face.points[k++] = numbers[mesh.tets[t][i]];
      std::ranges::sort(face.points);
      if (face.points[0] != face.points[1] && face.points[1] != face.points[2]) faces.push_back(face);
    }
  tbb::parallel_sort(faces.begin(), faces.end(),
                     [](const TetFace& a, const TetFace& b) { return a.points < b.points; });
  std::vector<OpenFace> open;
  for (auto first = faces.begin(); first != faces.end();) {
    const auto last =
        std::find_if(first, faces.end(), [&](const TetFace& face) { return face.points != first->points; });
    if (last - first == 1) open.push_back(open_face(mesh, numbers, *first));
    first = last;
  }
  return open;
}

void append(BoundaryFaces& to, const OpenFace& face, bool own) {
  const auto first = static_cast<std::uint32_t>(to.mesh.points.size());
  for (const std::size_t i :
       face.turned != 0 ? std::array<std::size_t, 3>{0, 2, 1} : std::array<std::size_t, 3>{0, 1, 2}) {
    to.mesh.points.push_back(face.corners[i]);
    to.mesh.values.push_back(face.values[i]);
  }
  to.mesh.triangles.push_back({first, first + 1, first + 2});
  to.own.push_back(own ? 1 : 0);
}

}  // namespace

BoundaryFaces boundary_faces(const scene::TetMeshView& mesh) {
  BoundaryFaces boundary;
  for (const OpenFace& face : open_faces(mesh)) append(boundary, face, true);
  return boundary;
}

BoundaryFaces boundary_faces(const scene::TetMeshView& part, exchange::Transport& transport, int owner) {
  std::vector<OpenFace> faces;
  if (transport.rank() == owner) faces = open_faces(part);
  for (OpenFace& face : faces) face.rank = static_cast<std::uint32_t>(owner);
  exchange::Bytes message = exchange::begin_message(exchange::MessageKind::open_faces, faces.size() * sizeof(OpenFace));
  exchange::append_list(message, faces);
  faces.clear();
  int rank = 0;
  for (const exchange::Bytes& bytes : exchange::gather_all(transport, std::move(message))) {
    exchange::MessageReader reader(bytes, rank++, exchange::MessageKind::open_faces);
    const auto part_of = reader.take_list<OpenFace>();
    reader.finish();
    faces.insert(faces.end(), part_of.begin(), part_of.end());
  }
  const auto key = [](const OpenFace& face) {
    return std::tuple(place(face.corners[0]), place(face.corners[1]), place(face.corners[2]));
  };
  tbb::parallel_sort(faces.begin(), faces.end(), [&](const OpenFace& a, const OpenFace& b) { return key(a) < key(b); });
  BoundaryFaces boundary;
  for (auto first = faces.begin(); first != faces.end();) {
    const auto last = std::find_if(first, faces.end(), [&](const OpenFace& face) { return key(face) != key(*first); });
    if (last - first == 1) append(boundary, *first, first->rank == static_cast<std::uint32_t>(owner));
    first = last;
  }
  return boundary;
}

std::vector<projection::SurfaceFaces> faces_of(const scene::Surfaces& surfaces, const scene::SurfaceSet& set,
                                               const BoundaryFaces* boundary, const std::vector<std::uint8_t>& here) {
  std::vector<projection::SurfaceFaces> faces;
  std::size_t number = 0;
  for (; number < surfaces.boundary.size(); ++number)
    if (boundary != nullptr)
      faces.push_back(
          {&boundary->mesh, set.face_crossing(number, false), set.face_crossing(number, true), boundary->own, here});
  for (const TriangleSurface& surface : surfaces.triangles) {
    const std::uint32_t crossing = set.face_crossing(number++, true);
    faces.push_back({surface.mesh.get(), crossing, crossing, {}, here});
  }
  return faces;
}

}  // namespace tessera::frame
