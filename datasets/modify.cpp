// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/modify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <utility>

#include "datasets/random.hpp"
#include "scene/error.hpp"

namespace tessera::datasets {

using scene::Association;
using scene::Tet;
using scene::TetMesh;

TetMesh transformed(TetMesh mesh, double scale, const glm::dvec3& offset) {
  for (glm::dvec3& p : mesh.positions) p = scale * p + offset;
  return mesh;
}

TetMesh inverted(TetMesh mesh, Orientation orientation) {
  const std::size_t step = orientation == Orientation::all_inverted ? 1 : 2;
  for (std::size_t t = 0; t < mesh.tets.size(); t += step) std::swap(mesh.tets[t][2], mesh.tets[t][3]);
  return mesh;
}

TetMesh with_cell_data(TetMesh mesh, int tets_per_cell) {
  const auto group = static_cast<std::size_t>(std::max(tets_per_cell, 1));
  if (tets_per_cell < 1 || mesh.tets.size() % group != 0)
    throw scene::bad_input(fmt::format("{} tets cannot be grouped into cells of {} tets; give a divisor",
                                       mesh.tets.size(), tets_per_cell));
  if (mesh.association == Association::cell) return mesh;
  std::vector<double> scalars(mesh.tets.size());
  mesh.original_cell.resize(mesh.tets.size());
  for (std::size_t first = 0; first < mesh.tets.size(); first += group) {
    double sum = 0;
    for (std::size_t t = first; t < first + group; ++t)
      for (const std::uint32_t v : mesh.tets[t]) sum += mesh.scalars[v];
    for (std::size_t t = first; t < first + group; ++t) {
      scalars[t] = sum / (4.0 * static_cast<double>(group));
      mesh.original_cell[t] = first / group;
    }
  }
  mesh.scalars = std::move(scalars);
  mesh.association = Association::cell;
  return mesh;
}

TetMesh with_seam(TetMesh mesh, int axis, double place) {
  constexpr std::uint32_t none = ~0u;
  std::vector<bool> beyond(mesh.tets.size()), used_beyond(mesh.positions.size(), false);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double sum = 0;
    for (const std::uint32_t v : mesh.tets[t]) sum += mesh.positions[v][axis];
    beyond[t] = !(sum * 0.25 < place);
    if (beyond[t])
      for (const std::uint32_t v : mesh.tets[t]) used_beyond[v] = true;
  }
  std::vector<std::uint32_t> twin(mesh.positions.size(), none);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (beyond[t]) continue;
    for (std::uint32_t& v : mesh.tets[t]) {
      if (!used_beyond[v]) continue;
      if (twin[v] == none) {
        twin[v] = static_cast<std::uint32_t>(mesh.positions.size());
        const glm::dvec3 p = mesh.positions[v];  // a copy: push_back may invalidate a reference
        mesh.positions.push_back(p);
        if (mesh.association == Association::point) {
          const double s = mesh.scalars[v];
          mesh.scalars.push_back(s);
        }
      }
      v = twin[v];
    }
  }
  return mesh;
}

TetMesh subdivided(const TetMesh& mesh) {
  constexpr std::array<std::array<std::size_t, 2>, 6> edges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  const std::size_t old_vertices = mesh.positions.size();

  // Edges are listed at their smaller vertex: count, prefix sum, fill, then sort each short list. The time is linear in
  // the size of the mesh.
  std::vector<std::uint64_t> start(old_vertices + 1, 0);
  const auto each_edge = [&](auto&& visit) {
    for (const Tet& tet : mesh.tets)
      for (const auto& e : edges) visit(std::minmax(tet[e[0]], tet[e[1]]));
  };
  each_edge([&](const std::pair<std::uint32_t, std::uint32_t>& e) { ++start[e.first + std::size_t{1}]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::uint32_t> ends(start.back());
  {
    std::vector<std::uint64_t> next(start.begin(), start.end() - 1);
    each_edge([&](const std::pair<std::uint32_t, std::uint32_t>& e) { ends[next[e.first]++] = e.second; });
  }
  std::vector<std::uint64_t> first_edge(old_vertices + 1, 0);  // distinct edges of the previous vertices
  for (std::size_t v = 0; v < old_vertices; ++v) {
    const auto begin = ends.begin() + static_cast<std::ptrdiff_t>(start[v]);
    const auto end = ends.begin() + static_cast<std::ptrdiff_t>(start[v + 1]);
    std::sort(begin, end);
    first_edge[v + 1] = first_edge[v] + static_cast<std::uint64_t>(std::unique(begin, end) - begin);
  }
  const std::uint64_t vertices = old_vertices + first_edge.back();
  if (vertices > std::numeric_limits<std::uint32_t>::max())
    throw scene::bad_input(fmt::format(
        "subdivision would make {} vertices, but at most 4294967295 are supported; subdivide less", vertices));

  TetMesh fine;
  fine.association = mesh.association;
  fine.field_name = mesh.field_name;
  fine.positions = mesh.positions;
  fine.positions.resize(vertices);
  const bool point = mesh.association == Association::point;
  if (point) {
    fine.scalars = mesh.scalars;
    fine.scalars.resize(vertices);
  }
  for (std::size_t v = 0; v < old_vertices; ++v)
    for (std::uint64_t i = 0; i < first_edge[v + 1] - first_edge[v]; ++i) {
      const std::uint32_t w = ends[start[v] + i];
      const std::size_t middle = old_vertices + first_edge[v] + i;
      fine.positions[middle] = 0.5 * (mesh.positions[v] + mesh.positions[w]);
      if (point) fine.scalars[middle] = 0.5 * (mesh.scalars[v] + mesh.scalars[w]);
    }

  const auto midpoint = [&](std::uint32_t a, std::uint32_t b) {
    const auto [v, w] = std::minmax(a, b);
    const auto begin = ends.begin() + static_cast<std::ptrdiff_t>(start[v]);
    const auto end = begin + static_cast<std::ptrdiff_t>(first_edge[v + std::size_t{1}] - first_edge[v]);
    const auto place = static_cast<std::uint64_t>(std::lower_bound(begin, end, w) - begin);
    return static_cast<std::uint32_t>(old_vertices + first_edge[v] + place);
  };
  fine.tets.reserve(8 * mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto [a, b, c, d] = mesh.tets[t];
    const std::uint32_t ab = midpoint(a, b), ac = midpoint(a, c), ad = midpoint(a, d), bc = midpoint(b, c),
                        bd = midpoint(b, d), cd = midpoint(c, d);
    // Four corners, then the octahedron around the diagonal ac-bd (Bey 1995, section 2).
    for (const Tet& child : {Tet{a, ab, ac, ad}, Tet{ab, b, bc, bd}, Tet{ac, bc, c, cd}, Tet{ad, bd, cd, d},
                             Tet{ab, ac, ad, bd}, Tet{ab, bc, ac, bd}, Tet{ac, ad, bd, cd}, Tet{ac, bd, bc, cd}}) {
      fine.tets.push_back(child);
      if (!point) fine.scalars.push_back(mesh.scalars[t]);
    }
  }
  return fine;
}

TetMesh shuffled(const TetMesh& mesh, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::uint32_t> place(mesh.positions.size());
  std::iota(place.begin(), place.end(), 0u);
  random.shuffle(place);
  std::vector<std::size_t> order(mesh.tets.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  random.shuffle(order);

  TetMesh out;
  out.association = mesh.association;
  out.field_name = mesh.field_name;
  const bool point = mesh.association == Association::point;
  out.positions.resize(mesh.positions.size());
  out.scalars.resize(mesh.scalars.size());
  for (std::size_t v = 0; v < place.size(); ++v) {
    out.positions[place[v]] = mesh.positions[v];
    if (point) out.scalars[place[v]] = mesh.scalars[v];
  }
  out.tets.reserve(order.size());
  for (const std::size_t t : order) {
    const Tet& tet = mesh.tets[t];
    if (!point) out.scalars[out.tets.size()] = mesh.scalars[t];
    out.tets.push_back({place[tet[0]], place[tet[1]], place[tet[2]], place[tet[3]]});
  }
  return out;
}

std::vector<TetMesh> parts(const TetMesh& mesh, int count, Partition partition, std::uint64_t seed) {
  if (count < 1) throw scene::bad_input(fmt::format("{} parts; give at least one", count));
  Random random(seed);
  const auto parts_count = static_cast<std::size_t>(count);
  std::vector<glm::dvec3> centres;
  if (partition == Partition::random_blobs) {
    const scene::Box box = bounds(mesh);
    for (std::size_t i = 0; i < 4 * parts_count; ++i) {
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      centres.push_back(box.low + glm::dvec3(x, y, z) * (box.high - box.low));
    }
  }
  const auto part_of = [&](const Tet& tet) {
    if (partition == Partition::interleaved) return static_cast<std::size_t>(random.below(parts_count));
    const glm::dvec3 p =
        0.25 * (mesh.positions[tet[0]] + mesh.positions[tet[1]] + mesh.positions[tet[2]] + mesh.positions[tet[3]]);
    const auto nearest = std::min_element(centres.begin(), centres.end(), [&](const auto& a, const auto& b) {
      return glm::dot(a - p, a - p) < glm::dot(b - p, b - p);
    });
    return static_cast<std::size_t>(nearest - centres.begin()) % parts_count;
  };

  const bool point = mesh.association == Association::point;
  std::vector<TetMesh> out(parts_count);
  std::vector<std::vector<std::uint32_t>> index(parts_count);
  for (std::size_t i = 0; i < parts_count; ++i) {
    out[i].association = mesh.association;
    out[i].field_name = mesh.field_name;
    index[i].assign(mesh.positions.size(), ~0u);
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const std::size_t p = part_of(mesh.tets[t]);
    Tet tet = mesh.tets[t];
    for (std::uint32_t& v : tet) {
      if (index[p][v] == ~0u) {
        index[p][v] = static_cast<std::uint32_t>(out[p].positions.size());
        out[p].positions.push_back(mesh.positions[v]);
        if (point) out[p].scalars.push_back(mesh.scalars[v]);
      }
      v = index[p][v];
    }
    out[p].tets.push_back(tet);
    out[p].original_cell.push_back(mesh.cell_of(t));
    if (!point) out[p].scalars.push_back(mesh.scalars[t]);
  }
  return out;
}

TetMesh merged(const std::vector<TetMesh>& parts) {
  TetMesh out;
  if (parts.empty()) return out;
  out.association = parts.front().association;
  out.field_name = parts.front().field_name;
  const bool cells_named =
      std::all_of(parts.begin(), parts.end(), [](const TetMesh& m) { return m.original_cell.size() == m.tets.size(); });
  for (const TetMesh& part : parts) {
    if (part.association != out.association) throw scene::bad_input("parts carry scalars on points and on cells");
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    out.positions.insert(out.positions.end(), part.positions.begin(), part.positions.end());
    out.scalars.insert(out.scalars.end(), part.scalars.begin(), part.scalars.end());
    for (const Tet& t : part.tets) out.tets.push_back({first + t[0], first + t[1], first + t[2], first + t[3]});
    if (cells_named)
      out.original_cell.insert(out.original_cell.end(), part.original_cell.begin(), part.original_cell.end());
  }
  return out;
}

}  // namespace tessera::datasets
