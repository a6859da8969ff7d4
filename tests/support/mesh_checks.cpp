// SPDX-License-Identifier: BSD-3-Clause
#include "support/mesh_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace tessera::io::testing {
namespace {

std::vector<double> values_of(const cells::BlockField& field) {
  std::vector<double> one(field.tuples), all(field.tuples * static_cast<std::size_t>(field.components));
  for (int c = 0; c < field.components; ++c) {
    field.read(c, 0, one);
    for (std::size_t k = 0; k < one.size(); ++k) all[k * static_cast<std::size_t>(field.components) + c] = one[k];
  }
  return all;
}

template <class Values>
std::string data_array(const std::string& name, const std::string& type, int components, const Values& values) {
  std::string text = fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n",
                                 type, name, components);
  for (const auto& value : values) text += fmt::format("{} ", value);
  return text + "\n</DataArray>\n";
}

std::string fields_text(const cells::CellBlock& block, scene::Association association,
                        const std::vector<std::uint8_t>& ghost) {
  std::string text;
  for (const cells::BlockField& field : block.fields)
    if (field.association == association) text += data_array(field.name, "Float64", field.components, values_of(field));
  if (!ghost.empty()) text += data_array("vtkGhostType", "UInt8", 1, ghost);
  return text;
}

/// The corner lists of one cube of the lattice, before renumbering.
struct Cell {
  std::uint8_t type;
  std::vector<std::uint32_t> corner;
};

using Corners = std::array<std::uint32_t, 8>;  // VTK's order of a hexahedron

/// Another numbering of the same hexahedron: rotated about its axis, tipped over, mirrored.
Corners renumbered(Corners c, std::mt19937& random) {
  for (unsigned turns = random() % 4; turns > 0; --turns) c = {c[1], c[2], c[3], c[0], c[5], c[6], c[7], c[4]};
  for (unsigned tips = random() % 4; tips > 0; --tips) c = {c[3], c[2], c[6], c[7], c[0], c[1], c[5], c[4]};
  if (random() % 2) c = {c[4], c[5], c[6], c[7], c[0], c[1], c[2], c[3]};
  return c;
}

}  // namespace

std::vector<std::pair<TrianglePlace, int>> count_triangles(const scene::TetMesh& mesh) {
  // Positions are sorted and numbered, because a map with triangles as keys is several times slower.
  std::vector<Point> places;
  for (const glm::dvec3& p : mesh.positions) places.push_back({p.x, p.y, p.z});
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<std::size_t> number;
  for (const glm::dvec3& p : mesh.positions)
    number.push_back(static_cast<std::size_t>(std::lower_bound(places.begin(), places.end(), Point{p.x, p.y, p.z}) -
                                              places.begin()));
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const scene::Tet& t : mesh.tets) {
    const std::array<std::size_t, 4> n = {number[t[0]], number[t[1]], number[t[2]], number[t[3]]};
    for (std::array<std::size_t, 3> triangle : {std::array{n[1], n[2], n[3]}, std::array{n[0], n[2], n[3]},
                                                std::array{n[0], n[1], n[3]}, std::array{n[0], n[1], n[2]}}) {
      std::sort(triangle.begin(), triangle.end());
      triangles.push_back(triangle);
    }
  }
  std::sort(triangles.begin(), triangles.end());
  std::vector<std::pair<TrianglePlace, int>> uses;
  for (std::size_t k = 0; k < triangles.size(); ++k)
    if (k > 0 && triangles[k] == triangles[k - 1])
      ++uses.back().second;
    else
      uses.push_back({{places[triangles[k][0]], places[triangles[k][1]], places[triangles[k][2]]}, 1});
  return uses;
}

std::string vtu_text(const cells::CellBlock& block) {
  std::vector<double> xyz;
  for (const glm::dvec3& p : block.positions) xyz.insert(xyz.end(), {p.x, p.y, p.z});
  std::vector<std::uint8_t> types = block.types;
  std::vector<std::uint64_t> ends(block.offsets.begin() + (block.offsets.empty() ? 0 : 1), block.offsets.end());
  std::vector<std::uint32_t> corners = block.connectivity;
  if (types.empty()) {
    for (const scene::Tet& tet : block.tets) corners.insert(corners.end(), tet.begin(), tet.end());
    types.assign(block.cell_count(), 10);
    for (std::size_t c = 1; c <= block.cell_count(); ++c) ends.push_back(4 * c);
  }
  std::string faces;
  if (!block.faces.empty()) {
    // VTK stores the end of each cell's faces.
    std::vector<std::int64_t> face_ends;
    for (const std::int64_t location : block.face_locations) {
      std::int64_t end = location;
      if (location >= 0) {
        const std::uint32_t count = block.faces[static_cast<std::size_t>(end++)];
        for (std::uint32_t f = 0; f < count; ++f) end += block.faces[static_cast<std::size_t>(end)] + 1;
      }
      face_ends.push_back(end);
    }
    faces = data_array("faces", "Int64", 1, block.faces) + data_array("faceoffsets", "Int64", 1, face_ends);
  }
  return fmt::format(
             "<VTKFile type=\"UnstructuredGrid\" version=\"2.2\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
             "<UnstructuredGrid><Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n",
             block.positions.size(), block.cell_count()) +
         fields_text(block, scene::Association::point, block.point_ghost) + "</PointData><CellData>\n" +
         fields_text(block, scene::Association::cell, block.cell_ghost) + "</CellData>\n<Points>\n" +
         data_array("Points", "Float64", 3, xyz) + "</Points>\n<Cells>\n" +
         data_array("connectivity", "Int64", 1, corners) + data_array("offsets", "Int64", 1, ends) +
         data_array("types", "UInt8", 1, types) + faces + "</Cells></Piece></UnstructuredGrid></VTKFile>\n";
}

std::string pvtu_text(const cells::CellBlock& block, const std::vector<std::string>& pieces) {
  std::string point, cell, sources;
  for (const cells::BlockField& field : block.fields)
    (field.association == scene::Association::point ? point : cell) += fmt::format(
        "<PDataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n", field.name, field.components);
  if (!block.cell_ghost.empty()) cell += "<PDataArray type=\"UInt8\" Name=\"vtkGhostType\"/>\n";
  for (const std::string& piece : pieces) sources += fmt::format("<Piece Source=\"{}\"/>\n", piece);
  return "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
         "<PUnstructuredGrid GhostLevel=\"0\">\n<PPointData>\n" +
         point + "</PPointData>\n<PCellData>\n" + cell +
         "</PCellData>\n<PPoints><PDataArray type=\"Float64\" NumberOfComponents=\"3\"/></PPoints>\n" + sources +
         "</PUnstructuredGrid></VTKFile>\n";
}

cells::CellBlock mixed_mesh(int n, unsigned seed, bool own_points) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.15, 0.15);
  const auto side = static_cast<std::uint32_t>(n + 1);
  std::vector<glm::dvec3> points;
  for (std::uint32_t k = 0; k < side; ++k)
    for (std::uint32_t j = 0; j < side; ++j)
      for (std::uint32_t i = 0; i < side; ++i) {
        glm::dvec3 p(i, j, k);
        for (int a = 0; a < 3; ++a)  // points on the sides of the box stay on them
          if (p[a] > 0 && p[a] < n) p[a] += jitter(random);
        points.push_back(p / static_cast<double>(n));
      }
  std::vector<Cell> cells;
  for (std::uint32_t j = 0; j + 1 < side; ++j)
    for (std::uint32_t i = 0; i + 1 < side; ++i) {
      const unsigned column = random() % 3;
      for (std::uint32_t k = 0; k + 1 < side; ++k) {
        const std::uint32_t v = i + side * (j + side * k), up = side * side;
        const Corners straight = {v,      v + 1,      v + 1 + side,      v + side,
                                  v + up, v + 1 + up, v + 1 + side + up, v + side + up};
        if (column == 0) {  // wedges, all cut in the same way so that their triangles match along the column
          std::array<std::array<int, 3>, 2> base = {{{0, 1, 2}, {0, 2, 3}}};
          for (auto b : base) {
            std::rotate(b.begin(), b.begin() + random() % 3, b.end());
            Cell wedge{13, {}};
            const int low = random() % 2 ? 0 : 4;
            for (const int layer : {low, 4 - low})
              for (const int corner : b) wedge.corner.push_back(straight[static_cast<std::size_t>(corner + layer)]);
            cells.push_back(std::move(wedge));
          }
          continue;
        }
        const Corners c = renumbered(straight, random);
        switch (random() % 3) {
          case 0:
            cells.push_back({12, {c.begin(), c.end()}});
            break;
          case 1:
            cells.push_back({11, {c[0], c[1], c[3], c[2], c[4], c[5], c[7], c[6]}});
            break;
          default: {
            glm::dvec3 centre(0);
            for (const std::uint32_t corner : c) centre += points[corner] / 8.0;
            const auto apex = static_cast<std::uint32_t>(points.size());
            points.push_back(centre);
            for (const std::array<int, 4>& f : std::array<std::array<int, 4>, 6>{
                     {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}})
              cells.push_back({14,
                               {c[static_cast<std::size_t>(f[0])], c[static_cast<std::size_t>(f[1])],
                                c[static_cast<std::size_t>(f[2])], c[static_cast<std::size_t>(f[3])], apex}});
          }
        }
      }
    }
  std::shuffle(cells.begin(), cells.end(), random);
  std::vector<std::uint32_t> place(points.size());
  std::iota(place.begin(), place.end(), 0u);
  std::shuffle(place.begin(), place.end(), random);

  cells::CellBlock block;
  if (!own_points) {
    block.positions.resize(points.size());
    for (std::size_t v = 0; v < points.size(); ++v) block.positions[place[v]] = points[v];
  }
  block.offsets.push_back(0);
  for (const Cell& cell : cells) {
    block.types.push_back(cell.type);
    for (const std::uint32_t corner : cell.corner) {
      if (own_points) block.positions.push_back(points[corner]);
      block.connectivity.push_back(own_points ? static_cast<std::uint32_t>(block.positions.size() - 1) : place[corner]);
    }
    block.offsets.push_back(block.connectivity.size());
  }
  std::vector<double> f;
  for (const glm::dvec3& p : block.positions) f.push_back(p.x + 2 * p.y + 3 * p.z);
  block.fields.push_back(cells::field_of_values("f", "double", scene::Association::point, 1, std::move(f)));
  return block;
}

}  // namespace tessera::io::testing
