// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <utility>
#include <vector>

/// Cubes, and OpenFOAM cases of them as text.
namespace tessera::io::testing {

/// [0, n]^3 divided into cubes.
struct Cubes {
  explicit Cubes(int side) : n(side) {
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) points.emplace_back(i, j, k);
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          cells.push_back({point(i, j, k), point(i + 1, j, k), point(i + 1, j + 1, k), point(i, j + 1, k),
                           point(i, j, k + 1), point(i + 1, j, k + 1), point(i + 1, j + 1, k + 1),
                           point(i, j + 1, k + 1)});
  }
  [[nodiscard]] int point(int i, int j, int k) const { return i + (n + 1) * (j + (n + 1) * k); }

  int n;
  std::vector<glm::dvec3> points;
  std::vector<std::array<int, 8>> cells;
};

inline std::string foam_head(const char* kind, const std::string& object) {
  return fmt::format(
      "FoamFile\n{{\n version 2.0;\n format ascii;\n arch \"LSB;label=32;scalar=64\";\n class {};\n object {};\n}}\n",
      kind, object);
}

/// Cells of one part of the cubes (those for which `keep` is true) as an OpenFOAM mesh with fields at the times 0 and
/// 1: `p` is the number of the cell among all, and 1000 at time 1.
inline void write_foam(const std::filesystem::path& folder, const Cubes& cubes, const std::function<bool(int)>& keep) {
  const int n = cubes.n;
  std::vector<int> local(cubes.cells.size(), -1), kept;
  for (int c = 0; c < static_cast<int>(local.size()); ++c)
    if (keep(c)) local[static_cast<std::size_t>(c)] = static_cast<int>(kept.size()), kept.push_back(c);
  struct Face {
    int owner, neighbour;
    std::array<int, 4> corners;
  };
  std::vector<Face> faces;
  constexpr int sides[6][4] = {{1, 2, 6, 5}, {3, 7, 6, 2}, {4, 5, 6, 7}, {0, 4, 7, 3}, {0, 1, 5, 4}, {0, 3, 2, 1}};
  const std::array<int, 6> steps{1, n, n * n, -1, -n, -n * n};
  for (const int c : kept) {
    const std::array<int, 3> at{c % n, c / n % n, c / (n * n)};
    for (std::size_t side = 0; side < 6; ++side) {
      const std::size_t axis = side % 3;
      const bool inside = side < 3 ? at[axis] + 1 < n : at[axis] > 0;
      const int other = inside ? local[static_cast<std::size_t>(c + steps[side])] : -1;
      if (side >= 3 && other >= 0) continue;  // the face belongs to the other cell
      Face face{local[static_cast<std::size_t>(c)], other, {}};
      for (std::size_t k = 0; k < 4; ++k)
        face.corners[k] = cubes.cells[static_cast<std::size_t>(c)][static_cast<std::size_t>(sides[side][k])];
      faces.push_back(face);
    }
  }
  std::stable_sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    if ((a.neighbour >= 0) != (b.neighbour >= 0)) return a.neighbour >= 0;
    return a.neighbour >= 0 && std::pair(a.owner, a.neighbour) < std::pair(b.owner, b.neighbour);
  });
  const auto inner = static_cast<std::size_t>(
      std::count_if(faces.begin(), faces.end(), [](const Face& f) { return f.neighbour >= 0; }));

  const auto mesh = folder / "constant" / "polyMesh";
  const auto write = [](const std::filesystem::path& file, const std::string& text) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  };
  std::string points = foam_head("vectorField", "points") + fmt::format("{}\n(\n", cubes.points.size());
  for (const glm::dvec3& p : cubes.points) points += fmt::format("({} {} {})\n", p.x, p.y, p.z);
  std::string corners = foam_head("faceList", "faces") + fmt::format("{}\n(\n", faces.size());
  std::string owners = foam_head("labelList", "owner") + fmt::format("{}\n(\n", faces.size());
  std::string neighbours = foam_head("labelList", "neighbour") + fmt::format("{}\n(\n", inner);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto& v = faces[f].corners;
    corners += fmt::format("4({} {} {} {})\n", v[0], v[1], v[2], v[3]);
    owners += fmt::format("{}\n", faces[f].owner);
    if (f < inner) neighbours += fmt::format("{}\n", faces[f].neighbour);
  }
  write(mesh / "points", points + ")\n");
  write(mesh / "faces", corners + ")\n");
  write(mesh / "owner", owners + ")\n");
  write(mesh / "neighbour", neighbours + ")\n");
  write(mesh / "boundary", foam_head("polyBoundaryMesh", "boundary") +
                               fmt::format("1\n(\nwalls\n{{\n type wall;\n nFaces {};\n startFace {};\n}}\n)\n",
                                           faces.size() - inner, inner));
  for (const int time : {0, 1}) {
    std::string p =
        foam_head("volScalarField", "p") +
        fmt::format("dimensions [0 2 -2 0 0 0 0];\ninternalField nonuniform List<scalar> {}\n(\n", kept.size());
    for (const int c : kept) p += fmt::format("{}\n", time == 0 ? c : 1000);
    write(folder / std::to_string(time) / "p", p + ")\n;\nboundaryField\n{\n walls\n {\n  type zeroGradient;\n }\n}\n");
  }
}

inline void write_control(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "system");
  std::ofstream(folder / "system" / "controlDict")
      << foam_head("dictionary", "controlDict")
      << "startFrom startTime;\nstartTime 0;\nendTime 1;\ndeltaT 1;\nwriteControl timeStep;\nwriteInterval 1;\n";
  std::ofstream(folder / "case.foam").flush();  // empty, as users create it
}

}  // namespace tessera::io::testing
