// SPDX-License-Identifier: BSD-3-Clause
#include "support/polyhedral_meshes.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "cells/cell_split.hpp"

namespace tessera::io::testing {
namespace {

/// Marks walls of the box among numbers of sites.
constexpr int wall = 1 << 20;

/// A corner of a Voronoi cell: the sorted sites and walls from which it is equally far, including the cell's own site.
using Meeting = std::array<int, 4>;

struct Corner {
  std::array<int, 3> planes;
  glm::dvec3 place;
};

/// A convex cell as its faces, each with its corners in order, from which half-spaces are cut off one by one.
class ConvexCell {
 public:
  ConvexCell() {
    for (int k = 0; k < 8; ++k)
      corners_.push_back({{wall + (k & 1), wall + 2 + (k >> 1 & 1), wall + 4 + (k >> 2)}, {k & 1, k >> 1 & 1, k >> 2}});
    const std::vector<std::vector<std::size_t>> faces = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                         {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
    for (std::size_t f = 0; f < 6; ++f) faces_.push_back({wall + static_cast<int>(f), faces[f]});
  }

  /// Keeps the part with dot(normal, x) <= offset.
  void cut(int plane, const glm::dvec3& normal, double offset) {
    std::vector<double> height;
    for (const Corner& c : corners_) height.push_back(glm::dot(normal, c.place) - offset);
    if (*std::max_element(height.begin(), height.end()) <= 0) return;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> cuts;
    std::map<std::size_t, std::vector<std::size_t>> rim;
    std::vector<Face> kept;
    for (const Face& face : faces_) {
      Face left{face.plane, {}};
      std::vector<std::size_t> ends;
      for (std::size_t k = 0; k < face.corners.size(); ++k) {
        const std::size_t a = face.corners[k], b = face.corners[(k + 1) % face.corners.size()];
        if (height[a] <= 0) left.corners.push_back(a);
        if ((height[a] <= 0) == (height[b] <= 0)) continue;
        const auto [low, high] = std::minmax(a, b);
        const auto [at, is_new] = cuts.try_emplace({low, high}, corners_.size());
        if (is_new) {
          Corner cut{{}, {}};
          cut.place = corners_[low].place +
                      (corners_[high].place - corners_[low].place) * (height[low] / (height[low] - height[high]));
          std::size_t n = 0;
          for (const int p : corners_[low].planes)
            if (std::count(corners_[high].planes.begin(), corners_[high].planes.end(), p) != 0) cut.planes[n++] = p;
          cut.planes[2] = plane;
          corners_.push_back(cut);
        }
        left.corners.push_back(at->second);
        ends.push_back(at->second);
      }
      if (ends.size() == 2) rim[ends[0]].push_back(ends[1]), rim[ends[1]].push_back(ends[0]);
      if (!left.corners.empty()) kept.push_back(left);
    }
    if (rim.empty()) return;  // only corners that have been removed already were on its outer side
    Face lid{plane, {rim.begin()->first}};
    while (lid.corners.size() < rim.size()) {
      const auto& next = rim[lid.corners.back()];
      const bool back = lid.corners.size() > 1 && next[0] == lid.corners[lid.corners.size() - 2];
      lid.corners.push_back(next[back ? 1 : 0]);
    }
    kept.push_back(lid);
    faces_ = std::move(kept);
  }

  struct Face {
    int plane;
    std::vector<std::size_t> corners;
  };
  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }
  [[nodiscard]] const Corner& corner(std::size_t k) const { return corners_[k]; }

 private:
  std::vector<Corner> corners_;
  std::vector<Face> faces_;
};

/// Merges neighbours at random; returns the group of each.
std::vector<std::size_t> random_groups(std::size_t count, const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                                       std::size_t largest, std::mt19937& random) {
  std::vector<std::size_t> group(count), size(count, 1);
  std::iota(group.begin(), group.end(), std::size_t{0});
  auto order = pairs;
  std::shuffle(order.begin(), order.end(), random);
  for (const auto& pair : order) {
    const std::size_t a = group[pair.first], b = group[pair.second];
    if (a == b || size[a] + size[b] > largest || random() % 4 == 0) continue;
    for (std::size_t& g : group)
      if (g == b) g = a;
    size[a] += size[b];
  }
  return group;
}

std::vector<Faces> gathered(const std::vector<std::size_t>& group, const std::vector<Faces>& parts) {
  std::map<std::size_t, Faces> cells;
  for (std::size_t k = 0; k < group.size(); ++k)
    cells[group[k]].insert(cells[group[k]].end(), parts[k].begin(), parts[k].end());
  std::vector<Faces> list;
  for (auto& [number, faces] : cells) list.push_back(std::move(faces));
  return list;
}

/// Removes the faces that two cells of one group share.
void drop_inner(Faces& faces) {
  std::map<std::vector<std::uint32_t>, int> uses;
  const auto key = [](std::vector<std::uint32_t> face) {
    std::sort(face.begin(), face.end());
    return face;
  };
  for (const auto& face : faces) ++uses[key(face)];
  std::erase_if(faces, [&](const auto& face) { return uses[key(face)] == 2; });
}

}  // namespace

cells::CellBlock polyhedra_of(std::vector<glm::dvec3> points, const std::vector<Faces>& cells, std::mt19937& random,
                              bool outward) {
  cells::CellBlock block;
  std::vector<double> f, c;
  for (const glm::dvec3& p : points) f.push_back(p.x + 2 * p.y + 3 * p.z);
  block.positions = std::move(points);
  block.offsets.push_back(0);
  for (const Faces& cell : cells) {
    block.types.push_back(42);
    std::set<std::uint32_t> corners;
    block.face_locations.push_back(static_cast<std::int64_t>(block.faces.size()));
    block.faces.push_back(static_cast<std::uint32_t>(cell.size()));
    for (std::vector<std::uint32_t> face : cell) {
      std::rotate(face.begin(), face.begin() + static_cast<std::ptrdiff_t>(random() % face.size()), face.end());
      if (!outward && random() % 2 == 0) std::reverse(face.begin(), face.end());
      block.faces.push_back(static_cast<std::uint32_t>(face.size()));
      block.faces.insert(block.faces.end(), face.begin(), face.end());
      corners.insert(face.begin(), face.end());
    }
    block.connectivity.insert(block.connectivity.end(), corners.begin(), corners.end());
    block.offsets.push_back(block.connectivity.size());
    c.push_back(static_cast<double>(c.size()));
  }
  block.fields.push_back(cells::field_of_values("f", "double", scene::Association::point, 1, std::move(f)));
  block.fields.push_back(cells::field_of_values("c", "double", scene::Association::cell, 1, std::move(c)));
  return block;
}

std::vector<Faces> faces_of_cells(const cells::CellBlock& block) {
  std::vector<Faces> cells(block.face_locations.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    auto at = static_cast<std::size_t>(block.face_locations[c]);
    for (std::uint32_t left = block.faces[at++]; left > 0; --left) {
      const std::uint32_t n = block.faces[at++];
      cells[c].emplace_back();
      for (std::uint32_t k = 0; k < n; ++k) cells[c].back().push_back(block.faces[at++]);
    }
  }
  return cells;
}

cells::CellBlock as_polyhedra(const cells::CellBlock& block, std::mt19937& random) {
  std::vector<Faces> cells;
  for (std::size_t c = 0; c < block.types.size(); ++c) {
    const std::span corner(block.connectivity.data() + block.offsets[c], block.offsets[c + 1] - block.offsets[c]);
    std::vector<std::uint32_t> list;
    if (block.types[c] == 10)
      list = {3, corner[0], corner[1], corner[2], 3, corner[0], corner[3], corner[1],
              3, corner[1], corner[3], corner[2], 3, corner[2], corner[3], corner[0]};
    cells::append_faces(cells::cell_shape(block.types[c]).kind, corner, list);
    Faces faces;
    for (std::size_t k = 0; k < list.size(); k += list[k] + 1)
      faces.emplace_back(list.begin() + static_cast<std::ptrdiff_t>(k + 1),
                         list.begin() + static_cast<std::ptrdiff_t>(k + 1 + list[k]));
    std::shuffle(faces.begin(), faces.end(), random);
    cells.push_back(std::move(faces));
  }
  return polyhedra_of(block.positions, cells, random);
}

cells::CellBlock voronoi_mesh(int sites, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> anywhere(0, 1);
  std::vector<glm::dvec3> site;
  for (int k = 0; k < sites; ++k) site.emplace_back(anywhere(random), anywhere(random), anywhere(random));
  std::map<Meeting, std::uint32_t> numbers;
  std::vector<glm::dvec3> points;
  std::vector<Faces> cells;
  for (int i = 0; i < sites; ++i) {
    ConvexCell cell;
    for (int j = 0; j < sites; ++j) {
      const glm::dvec3 a = site[static_cast<std::size_t>(i)], b = site[static_cast<std::size_t>(j)];
      if (j != i) cell.cut(j, b - a, glm::dot(b - a, 0.5 * (a + b)));
    }
    Faces faces;
    for (const ConvexCell::Face& face : cell.faces()) {
      faces.emplace_back();
      for (const std::size_t k : face.corners) {
        const Corner& corner = cell.corner(k);
        Meeting meeting{i, corner.planes[0], corner.planes[1], corner.planes[2]};
        std::sort(meeting.begin(), meeting.end());
        const auto [at, is_new] = numbers.try_emplace(meeting, static_cast<std::uint32_t>(points.size()));
        if (is_new) points.push_back(corner.place);
        faces.back().push_back(at->second);
      }
    }
    cells.push_back(std::move(faces));
  }
  return polyhedra_of(std::move(points), cells, random);
}

cells::CellBlock agglomerates(int n, int largest, double jitter, unsigned seed,
                              std::vector<std::size_t>* cell_of_cube) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-jitter, jitter);
  const auto side = static_cast<std::uint32_t>(n + 1);
  std::vector<glm::dvec3> points;
  for (std::uint32_t k = 0; k < side; ++k)
    for (std::uint32_t j = 0; j < side; ++j)
      for (std::uint32_t i = 0; i < side; ++i) {
        glm::dvec3 p(i, j, k);
        for (int a = 0; a < 3; ++a)
          if (p[a] > 0 && p[a] < n) p[a] += move(random);
        points.push_back(p / static_cast<double>(n));
      }
  std::vector<Faces> cubes;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  const auto wide = static_cast<std::size_t>(n);
  for (std::uint32_t k = 0; k + 1 < side; ++k)
    for (std::uint32_t j = 0; j + 1 < side; ++j)
      for (std::uint32_t i = 0; i + 1 < side; ++i) {
        const std::uint32_t v = i + side * (j + side * k), u = side, w = side * side;
        cubes.push_back({{v, v + u, v + u + 1, v + 1},
                         {v + w, v + w + 1, v + w + u + 1, v + w + u},
                         {v, v + 1, v + w + 1, v + w},
                         {v + u, v + u + w, v + u + w + 1, v + u + 1},
                         {v, v + w, v + w + u, v + u},
                         {v + 1, v + u + 1, v + w + u + 1, v + w + 1}});
        const std::size_t c = cubes.size() - 1;
        if (i + 2 < side) pairs.emplace_back(c, c + 1);
        if (j + 2 < side) pairs.emplace_back(c, c + wide);
        if (k + 2 < side) pairs.emplace_back(c, c + wide * wide);
      }
  const std::vector<std::size_t> group = random_groups(cubes.size(), pairs, static_cast<std::size_t>(largest), random);
  std::vector<Faces> cells = gathered(group, cubes);
  if (cell_of_cube != nullptr) {
    const std::set<std::size_t> groups(group.begin(), group.end());
    cell_of_cube->clear();
    for (const std::size_t g : group)
      cell_of_cube->push_back(static_cast<std::size_t>(std::distance(groups.begin(), groups.find(g))));
  }
  for (Faces& cell : cells) drop_inner(cell);
  return polyhedra_of(std::move(points), cells, random, true);
}

cells::CellBlock polyominoes(int n, int layers, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-0.25, 0.25);
  const auto side = static_cast<std::uint32_t>(n + 1), map = side * side;
  std::vector<glm::dvec3> points;
  for (std::uint32_t j = 0; j < side; ++j)
    for (std::uint32_t i = 0; i < side; ++i) {
      glm::dvec3 p(i, j, 0);
      for (int a = 0; a < 2; ++a)
        if (p[a] > 0 && p[a] < n) p[a] += move(random);
      points.push_back(p / static_cast<double>(n));
    }
  for (int k = 1; k <= layers; ++k)
    for (std::uint32_t v = 0; v < map; ++v)
      points.emplace_back(points[v].x, points[v].y, static_cast<double>(k) / layers);
  std::vector<Faces> squares;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::uint32_t j = 0; j + 1 < side; ++j)
    for (std::uint32_t i = 0; i + 1 < side; ++i) {
      const std::uint32_t v = i + side * j;
      squares.push_back({{v, v + 1}, {v + 1, v + 1 + side}, {v + 1 + side, v + side}, {v + side, v}});
      const std::size_t c = squares.size() - 1;
      if (i + 2 < side) pairs.emplace_back(c, c + 1);
      if (j + 2 < side) pairs.emplace_back(c, c + static_cast<std::size_t>(n));
    }
  std::vector<Faces> cells;
  for (Faces outline : gathered(random_groups(squares.size(), pairs, 4, random), squares)) {
    drop_inner(outline);
    std::map<std::uint32_t, std::uint32_t> next;
    for (const auto& edge : outline) next[edge[0]] = edge[1];
    std::vector<std::uint32_t> ring = {next.begin()->first};
    while (ring.size() < outline.size()) ring.push_back(next[ring.back()]);
    for (int k = 0; k < layers; ++k) {
      const std::uint32_t low = static_cast<std::uint32_t>(k) * map, high = low + map;
      Faces faces(2);
      for (std::size_t e = 0; e < ring.size(); ++e) {
        const std::uint32_t a = ring[e], b = ring[(e + 1) % ring.size()];
        faces[0].push_back(a + high);
        faces[1].insert(faces[1].begin(), a + low);
        faces.push_back({a + low, b + low, b + high, a + high});
      }
      cells.push_back(std::move(faces));
    }
  }
  return polyhedra_of(std::move(points), cells, random);
}

}  // namespace tessera::io::testing
