// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>

/// Two slightly curved tets of ten nodes that share a face, as files.
namespace tessera::test {

/// Returns one of the two tets as the text of a .vtu: the tet below or above the shared face.
inline std::string quadratic_tet_text(bool above) {
  using Point = std::array<double, 3>;
  const std::array<Point, 4> corner = {
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, above ? Point{0.2, 0.2, 1} : Point{0.3, 0.3, -1}}};
  static constexpr int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  std::string points, values;
  const auto add = [&](const Point& p) {
    const double x = p[0] + 0.03 * p[1] * p[1], y = p[1] + 0.02 * p[2] * p[2], z = p[2] + 0.04 * p[0] * p[0];
    points += fmt::format("{} {} {} ", x, y, z);
    values += fmt::format("{} ", z + 0.05 * (x * x + y * z));
  };
  for (const Point& p : corner) add(p);
  for (const auto& [a, b] : edges) {
    const Point &p = corner[static_cast<std::size_t>(a)], &q = corner[static_cast<std::size_t>(b)];
    add({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
  }
  return fmt::format(
      "<VTKFile type=\"UnstructuredGrid\" version=\"2.2\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
      "<UnstructuredGrid><Piece NumberOfPoints=\"10\" NumberOfCells=\"1\"><PointData><DataArray type=\"Float64\" "
      "Name=\"f\" format=\"ascii\">{}</DataArray></PointData><Points><DataArray type=\"Float64\" "
      "NumberOfComponents=\"3\" format=\"ascii\">{}</DataArray></Points><Cells><DataArray type=\"Int64\" "
      "Name=\"connectivity\" format=\"ascii\">0 1 2 3 4 5 6 7 8 9</DataArray><DataArray type=\"Int64\" "
      "Name=\"offsets\" format=\"ascii\">10</DataArray><DataArray type=\"UInt8\" Name=\"types\" "
      "format=\"ascii\">24</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>\n",
      values, points);
}

/// Returns a .pvtu of both tets, which are stored next to the .pvtu in below.vtu and above.vtu.
inline std::string quadratic_pair_text() {
  return "<VTKFile type=\"PUnstructuredGrid\" version=\"2.2\" byte_order=\"LittleEndian\"><PUnstructuredGrid "
         "GhostLevel=\"0\"><PPointData><PDataArray type=\"Float64\" Name=\"f\"/></PPointData><PPoints><PDataArray "
         "type=\"Float64\" NumberOfComponents=\"3\"/></PPoints><Piece Source=\"below.vtu\"/><Piece "
         "Source=\"above.vtu\"/></PUnstructuredGrid></VTKFile>\n";
}

}  // namespace tessera::test
