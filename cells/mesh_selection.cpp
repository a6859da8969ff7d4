// SPDX-License-Identifier: BSD-3-Clause
#include "cells/mesh_selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cells/cell_split.hpp"
#include "scene/error.hpp"

namespace tessera::cells {
namespace {

using scene::Association;
using scene::Tet;

bool comes_first(const glm::dvec3& p, const glm::dvec3& q) { return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z); }

/// Some of a mesh's tets, possibly cut into smaller tets.
struct KeptTets {
  std::vector<Tet> tets;
  std::vector<double> scalars;  ///< values of the tets, for cell data
  std::vector<std::uint64_t> cells;

  void add(const Tet& tet, const scene::TetMesh& mesh, std::size_t of) {
    tets.push_back(tet);
    if (mesh.association == Association::cell) scalars.push_back(mesh.scalars[of]);
    cells.push_back(mesh.cell_of(of));
  }
  void move_to(scene::TetMesh& mesh) {
    mesh.tets = std::move(tets);
    if (mesh.association == Association::cell) mesh.scalars = std::move(scalars);
    mesh.original_cell = std::move(cells);
  }
};

/// Returns the number of cells that have tets; the tets of a cell are consecutive.
std::uint64_t cells_with_tets(const scene::TetMesh& mesh) {
  std::uint64_t cells = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (t == 0 || mesh.cell_of(t) != mesh.cell_of(t - 1)) ++cells;
  return cells;
}

void apply_threshold(scene::TetMesh& mesh, const std::array<double, 2>& range) {
  const auto in_range = [&](double value) { return range[0] <= value && value <= range[1]; };
  const auto tet_in_range = [&](std::size_t t) {
    if (mesh.association == Association::cell) return in_range(mesh.scalars[t]);
    const Tet& tet = mesh.tets[t];
    return std::all_of(tet.begin(), tet.end(), [&](std::uint32_t v) { return in_range(mesh.scalars[v]); });
  };
  KeptTets kept;
  for (std::size_t first = 0, last = 0; first < mesh.tets.size(); first = last) {
    bool keeps = true;
    for (last = first; last < mesh.tets.size() && mesh.cell_of(last) == mesh.cell_of(first); ++last)
      keeps = keeps && tet_in_range(last);
    for (std::size_t t = first; keeps && t < last; ++t) kept.add(mesh.tets[t], mesh, t);
  }
  kept.move_to(mesh);
}

/// Cuts a mesh by a half-space and keeps the part inside the half-space.
class HalfSpaceCut {
 public:
  HalfSpaceCut(scene::TetMesh& mesh, const scene::HalfSpace& kept, std::span<const double> levels,
               const std::string& source)
      : mesh_(mesh), point_(kept.point), normal_(scene::unit_normal(kept)), levels_(levels), source_(source) {
    sides_.reserve(mesh.positions.size());
    for (const glm::dvec3& p : mesh.positions) sides_.push_back(side_of(p));
  }

  [[nodiscard]] bool misses() const {
    return std::none_of(sides_.begin(), sides_.end(), [](std::int8_t side) { return side < 0; });
  }

  /// Sets corners on the plane to exact levels.
  void level_corners() {
    if (levels_.empty() || mesh_.association != Association::point) return;
    for (const Tet& tet : mesh_.tets) {
      double size = 0;
      for (const std::uint32_t v : tet) size = std::max(size, std::abs(mesh_.scalars[v]));
      for (const std::uint32_t v : tet)
        if (sides_[v] == 0) mesh_.scalars[v] = at_level(mesh_.scalars[v], size);
    }
  }

  /// Cuts the mesh. Appends each cell that loses a part, once.
  void apply(std::vector<std::uint64_t>& changed) {
    KeptTets kept;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      std::array<int, 3> count{};  // number of corners outside, on and inside the plane
      for (const std::uint32_t v : mesh_.tets[t]) ++count[static_cast<std::size_t>(sides_[v] + 1)];
      if (count[0] == 0 && count[2] > 0) {
        kept.add(mesh_.tets[t], mesh_, t);
        continue;
      }
      const std::uint64_t cell = mesh_.cell_of(t);
      if (changed.empty() || changed.back() != cell) changed.push_back(cell);
      if (count[2] == 0) continue;
      split(mesh_.tets[t], count);
      for (const Tet& piece : pieces_)
        if (has_extent(piece)) kept.add(piece, mesh_, t);
    }
    kept.move_to(mesh_);
  }

 private:
  [[nodiscard]] double distance(const glm::dvec3& p) const { return glm::dot(normal_, p - point_); }

  /// Returns the level that a scalar equals up to rounding, for scalars of this size.
  [[nodiscard]] double at_level(double scalar, double size) const {
    constexpr double rounding = 1e-12;  // some thousand units in the last place of the coordinates
    for (const double level : levels_)
      if (std::abs(scalar - level) <= rounding * size) return level;
    return scalar;
  }

  /// Returns -1 for a corner outside, 1 inside, and 0 on the plane, within the rounding of the distance. The result
  /// depends only on the corner, so that all tets that share the corner agree.
  [[nodiscard]] std::int8_t side_of(const glm::dvec3& p) const {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    const double d = distance(p);
    if (std::abs(d) <= rounding * glm::dot(glm::abs(normal_), glm::abs(p) + glm::abs(point_))) return 0;
    return d < 0 ? -1 : 1;
  }

  /// Splits the part of a tet inside the half-space into tets, if the tet has corners inside.
  void split(const Tet& tet, const std::array<int, 3>& count) {
    std::array<std::uint32_t, 4> order = tet;  // corners sorted: inside, on the plane, outside
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return sides_[a] > sides_[b]; });
    const auto [p, q, r, s] = order;
    pieces_.clear();
    const auto [outside, on, inside] = count;
    if (inside == 1) {
      pieces_.push_back({p, at_plane(p, q), at_plane(p, r), at_plane(p, s)});
    } else if (inside == 3) {
      split_into(CellKind::wedge, std::array{p, q, r, cut(p, s), cut(q, s), cut(r, s)});
    } else if (on == 1) {
      split_into(CellKind::pyramid, std::array{p, q, cut(q, s), cut(p, s), r});
    } else {
      split_into(CellKind::wedge, std::array{p, cut(p, r), cut(p, s), q, cut(q, r), cut(q, s)});
    }
  }

  template <std::size_t corners>
  void split_into(CellKind kind, const std::array<std::uint32_t, corners>& corner) {
    split_cell(kind, corner, mesh_.positions, pieces_);
  }

  /// Returns the intersection of the plane with the edge from a corner inside to another corner.
  std::uint32_t at_plane(std::uint32_t inside, std::uint32_t other) {
    return sides_[other] == 0 ? other : cut(inside, other);
  }

  /// Returns the new vertex on an edge that the plane cuts.
  std::uint32_t cut(std::uint32_t a, std::uint32_t b) {
    if (comes_first(mesh_.positions[b], mesh_.positions[a])) std::swap(a, b);
    const std::uint64_t edge = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
    const auto known = vertices_.find(edge);
    if (known != vertices_.end()) return known->second;
    if (mesh_.positions.size() >= std::numeric_limits<std::uint32_t>::max())
      throw scene::bad_input(
          fmt::format("{}: `clip` makes more than 2^32 - 1 points; use more processes, or fewer planes", source_));
    const double from = distance(mesh_.positions[a]), to = distance(mesh_.positions[b]), share = from / (from - to);
    const glm::dvec3 p = mesh_.positions[a], q = mesh_.positions[b];
    glm::dvec3 place(std::lerp(p.x, q.x, share), std::lerp(p.y, q.y, share), std::lerp(p.z, q.z, share));
    // On an axis-aligned plane the coordinate is exact.
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(normal_[axis]) == 1) place[axis] = point_[axis];
    mesh_.positions.push_back(place + 0.0);  // -0 becomes 0
    sides_.push_back(0);
    if (mesh_.association == Association::point) {
      const double at_a = mesh_.scalars[a], at_b = mesh_.scalars[b];
      mesh_.scalars.push_back(at_level(std::lerp(at_a, at_b, share), std::max(std::abs(at_a), std::abs(at_b))));
    }
    const auto vertex = static_cast<std::uint32_t>(mesh_.positions.size() - 1);
    vertices_.emplace(edge, vertex);
    return vertex;
  }

  /// Whether a tet is not flat: a cut next to a corner may coincide with the corner up to rounding.
  [[nodiscard]] bool has_extent(const Tet& tet) const {
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (mesh_.positions[tet[i]] == mesh_.positions[tet[j]]) return false;
    return true;
  }

  scene::TetMesh& mesh_;
  glm::dvec3 point_, normal_;
  std::span<const double> levels_;
  const std::string& source_;
  std::vector<std::int8_t> sides_;  ///< per vertex
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
  std::vector<Tet> pieces_;
};

/// Keeps the used vertices, in order.
void drop_unused(scene::TetMesh& mesh) {
  std::vector<std::uint32_t> number(mesh.positions.size(), 0);
  for (const Tet& tet : mesh.tets)
    for (const std::uint32_t v : tet) number[v] = 1;
  const bool point = mesh.association == Association::point;
  std::uint32_t used = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) continue;
    mesh.positions[used] = mesh.positions[v];
    if (point) mesh.scalars[used] = mesh.scalars[v];
    number[v] = used++;
  }
  mesh.positions.resize(used);
  if (point) mesh.scalars.resize(used);
  for (Tet& tet : mesh.tets)
    for (std::uint32_t& v : tet) v = number[v];
}

/// Returns how many of the changed cells still have tets.
std::uint64_t cells_left_of(std::vector<std::uint64_t> changed, const scene::TetMesh& mesh) {
  std::sort(changed.begin(), changed.end());
  std::uint64_t left = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if ((t == 0 || mesh.cell_of(t) != mesh.cell_of(t - 1)) &&
        std::binary_search(changed.begin(), changed.end(), mesh.cell_of(t)))
      ++left;
  return left;
}

}  // namespace

void select(scene::TetMesh& mesh, const scene::Selection& selection, MeshCounts& counts, const std::string& source) {
  if (selection.all()) return;
  validate(selection);
  const std::uint64_t cells = cells_with_tets(mesh);
  if (selection.threshold) apply_threshold(mesh, *selection.threshold);
  const std::uint64_t cells_in_range = cells_with_tets(mesh);
  counts.cells_out_of_range += cells - cells_in_range;
  std::vector<std::uint64_t> changed;
  for (const scene::HalfSpace& kept : selection.clip) {
    HalfSpaceCut cut(mesh, kept, selection.levels, source);
    cut.level_corners();
    if (!cut.misses()) cut.apply(changed);
  }
  counts.cells_clipped += cells_in_range - cells_with_tets(mesh);
  counts.cells_cut += cells_left_of(std::move(changed), mesh);
  counts.tets_made = mesh.tets.size();
  drop_unused(mesh);
}

void require_selected(const MeshCounts& n, const std::string& source) {
  if (n.tets_made > 0 || n.cells_out_of_range + n.cells_clipped == 0) return;
  const std::string kept =
      n.cells_clipped == 0 ? "no cell has all its values in `threshold`; give a wider range"
      : n.cells_out_of_range == 0
          ? "nothing is on the side that `clip` keeps, to which its normal points; reverse the normal or move the plane"
          : fmt::format(
                "`threshold` removes {} cells, and `clip` removes the others; give a wider range or move the plane",
                n.cells_out_of_range);
  throw scene::bad_input(
      fmt::format("{}: nothing is left to render: {} (`tessera info` prints bounds and ranges)", source, kept));
}

}  // namespace tessera::cells
