// SPDX-License-Identifier: BSD-3-Clause
#include "cells/block_tets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <stdexcept>

#include "cells/ghost_bits.hpp"
#include "scene/directions.hpp"
#include "scene/error.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::cells {
namespace {

using scene::Tet;

/// Number of tets allowed for each higher-order cell, in addition to CurvedSettings::all for all of them.
constexpr std::uint64_t each_curved_cell = 64;

/// Returns the counters for cells of a kind and for the tangled cells among them; null: not counted.
std::array<std::uint64_t MeshCounts::*, 2> counters_of(CellKind kind) {
  switch (kind) {
    case CellKind::hexahedron:
      return {&MeshCounts::hexahedra, &MeshCounts::hexahedra_tangled};
    case CellKind::wedge:
      return {&MeshCounts::wedges, &MeshCounts::wedges_tangled};
    case CellKind::pyramid:
      return {&MeshCounts::pyramids, &MeshCounts::pyramids_tangled};
    case CellKind::voxel:
      return {&MeshCounts::voxels, &MeshCounts::voxels_tangled};
    case CellKind::pentagonal_prism:
    case CellKind::hexagonal_prism:
      return {&MeshCounts::prisms, &MeshCounts::prisms_tangled};
    default:
      return {};
  }
}

}  // namespace

BlockCells::BlockCells(const CellBlock& block, std::span<const glm::dvec3> points, std::span<const double> values,
                       scene::Association association, const std::string& source, const CurvedSettings& curved,
                       const HigherOrderCells& before)
    : block_(block),
      points_(points),
      values_(values),
      association_(association),
      source_(source),
      curved_(block, points, values, association, curved),
      most_curved_tets_(curved.all + each_curved_cell * (before.divided + block.types.size())) {
  most_curved_tets_ -= std::min(most_curved_tets_, before.tets);
  for (std::size_t type = 0; type < shapes_.size(); ++type) shapes_[type] = cell_shape(static_cast<std::uint8_t>(type));
}

void BlockCells::split(std::size_t first, std::size_t last, BlockTets& out) const {
  out.tets.clear(), out.cells.clear();
  out.added.clear(), out.added_values.clear(), out.nodes.clear();
  out.counts = {};
  out.curved = {};
  out.error = nullptr;
  SplitScratch work{
      .tets = {}, .faces = {}, .corners = {}, .polyhedra = {}, .curved = CurvedWork(curved_.settings().tolerance)};
  for (std::size_t c = first; c < last; ++c) {
    const std::size_t tets = out.tets.size();
    const std::uint64_t tangled = out.counts.cells_tangled;
    split_cell(c, work, out);
    if (block_.types.empty() || out.tets.size() == tets) continue;
    if (const auto [all, of_them_tangled] = counters_of(shapes_[block_.types[c]].kind); all != nullptr) {
      ++(out.counts.*all);
      out.counts.*of_them_tangled += out.counts.cells_tangled - tangled;
    }
  }
  out.counts.cells_read = last - first;
}

void BlockCells::split_cell(std::size_t c, SplitScratch& work, BlockTets& out) const {
  const bool all_tets = block_.types.empty();
  const std::uint8_t type = all_tets ? vtk_number(CellType::tetra) : block_.types[c];
  const CellShape& shape = shapes_[type];
  const std::size_t nodes = all_tets ? 4 : block_.offsets[c + 1] - block_.offsets[c];
  if (shape.kind == CellKind::not_volumetric) {
    ++out.counts.cells_not_volumetric;
    return;
  }
  if (shape.kind == CellKind::unsupported)
    throw scene::bad_input(
        fmt::format("{}: {} is a {}, which is not rendered; split such cells into tetrahedra "
                    "first (ParaView: Tetrahedralize)",
                    source_, place(c), cell_type_name(type)));
  if (shape.kind == CellKind::polyhedron || shape.kind == CellKind::convex_point_set)
    return split_polyhedron(c, shape.kind, work, out);
  if (shape.nodes ? nodes != static_cast<std::size_t>(shape.nodes) : nodes < static_cast<std::size_t>(shape.corners))
    throw scene::bad_input(fmt::format("{}: {} is a {} with {} nodes, but must have {}; correct the cell types",
                                       source_, place(c), cell_type_name(type), nodes,
                                       shape.nodes ? shape.nodes : shape.corners));
  const std::uint32_t* const first = all_tets ? block_.tets[c].data() : &block_.connectivity[block_.offsets[c]];
  const bool is_curved = shape.higher_order && curved_.lattice(c) != nullptr;
  const std::span<const std::uint32_t> corner(first, is_curved ? nodes : static_cast<std::size_t>(shape.corners));
  if (is_left_out(c, corner, out)) return;
  if (shape.higher_order) ++out.counts.cells_quadratic;
  if (is_curved) return split_curved(c, work, out);
  if (shape.higher_order) ++out.curved.by_corners;
  const bool is_prism = shape.kind == CellKind::pentagonal_prism || shape.kind == CellKind::hexagonal_prism;
  if (is_prism) {
    work.faces.clear();
    append_faces(shape.kind, corner, work.faces);
  }
  if (!is_prism || work.polyhedra.are_fans(work.faces, points_)) {
    work.tets.clear();
    cells::split_cell(shape.kind, corner, points_, work.tets);
    const auto place_of = [&](std::uint32_t v) { return points_[v]; };
    const std::size_t tets = out.tets.size();
    const std::uint64_t collapsed = out.counts.tets_collapsed;
    if (!keep_tets(c, work.tets, place_of, out) || shape.kind == CellKind::tet) return;
    // If the tets overlap, another method may still split the cell.
    out.tets.resize(tets), out.cells.resize(tets);
    out.counts.tets_collapsed = collapsed;
    --out.counts.cells_tangled;
    work.faces.clear();
    append_faces(shape.kind, corner, work.faces);
  }
  if (work.polyhedra.split(work.faces, points_)) {
    keep_filled(c, work.polyhedra, out);
    return;
  }
  // Repeated corners may have made the surface open.
  work.tets.clear();
  cells::split_cell(shape.kind, corner, points_, work.tets);
  keep_tets(
      c, work.tets, [&](std::uint32_t v) { return points_[v]; }, out);
}

void BlockCells::split_curved(std::size_t c, SplitScratch& work, BlockTets& out) const {
  try {
    curved_.split(c, work.curved);
  } catch (const std::length_error&) {
    throw scene::bad_input(
        fmt::format("{}: {} cannot be approximated closely enough by {} tets; allow a larger difference "
                    "(`higher_order_tolerance`) or more tets (`higher_order_tets`)",
                    source_, place(c), curved_.settings().limit));
  }
  const CurvedSplitter& split = work.curved.splitter;
  // Whether the limit is exceeded depends only on all cells together. Which cell detects that depends on the timing of
  // threads.
  const std::uint64_t so_far = curved_tets_.fetch_add(split.tets().size()) + split.tets().size();
  if (so_far > most_curved_tets_)
    throw scene::bad_input(
        fmt::format("{}: its higher-order cells up to {} cannot be approximated closely enough by {} tets; allow a "
                    "larger difference (`higher_order_tolerance`) or more tets (`higher_order_tets`)",
                    source_, place(c), most_curved_tets_));
  const std::uint32_t* const node = &block_.connectivity[block_.offsets[c]];
  out.nodes.insert(out.nodes.end(), node, &block_.connectivity[0] + block_.offsets[c + 1]);
  const auto corners = static_cast<std::uint32_t>(split.corners());
  const auto first_added = static_cast<std::uint32_t>(points_.size() + out.added.size());
  for (const glm::dvec4& point : split.added()) {
    out.added.emplace_back(point.x, point.y, point.z);
    if (association_ == scene::Association::point) out.added_values.push_back(point.w);
  }
  work.tets.clear();
  for (const Tet& tet : split.tets()) {
    Tet& made = work.tets.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) made[k] = tet[k] < corners ? node[tet[k]] : first_added + (tet[k] - corners);
  }
  out.curved.divided += 1;
  out.curved.tets += work.tets.size();
  out.curved.position_error = std::max(out.curved.position_error, split.error().position);
  out.curved.field_error = std::max(out.curved.field_error, split.error().field);
  const auto own = static_cast<std::uint32_t>(points_.size());
  keep_tets(
      c, work.tets, [&](std::uint32_t v) { return v < own ? points_[v] : out.added[v - own]; }, out);
}

void BlockCells::split_polyhedron(std::size_t c, CellKind kind, SplitScratch& work, BlockTets& out) const {
  const bool has_faces = kind == CellKind::polyhedron;
  if (has_faces && (block_.face_locations.empty() || block_.face_locations[c] == CellBlock::no_faces))
    throw scene::bad_input(
        fmt::format("{}: {} is a polyhedron without a list of its faces; write it with its faces", source_, place(c)));
  work.corners.clear();
  std::span<const std::uint32_t> faces;
  if (has_faces) {
    faces = faces_of(c);
    for (std::size_t k = 0; k < faces.size(); k += faces[k] + 1)
      for (const std::uint32_t v : faces.subspan(k + 1, faces[k])) work.corners.push_back(v);
  } else {
    for (std::uint64_t k = block_.offsets[c]; k < block_.offsets[c + 1]; ++k)
      work.corners.push_back(block_.connectivity[k]);
  }
  if (is_left_out(c, work.corners, out)) return;
  const auto fill = has_faces ? work.polyhedra.split(faces, points_) : work.polyhedra.split_hull(work.corners, points_);
  if (!fill) {
    ++out.counts.cells_open;
    return;
  }
  ++out.counts.cells_polyhedra;
  if (*fill == SurfaceFill::from_inside) ++out.counts.polyhedra_from_inside;
  if (*fill == SurfaceFill::in_pieces) ++out.counts.polyhedra_in_pieces;
  if (keep_filled(c, work.polyhedra, out)) ++out.counts.polyhedra_tangled;
}

/// The faces of a polyhedron, without the number of faces.
std::span<const std::uint32_t> BlockCells::faces_of(std::size_t c) const {
  const auto first = static_cast<std::size_t>(block_.face_locations[c]);
  std::size_t end = first + 1;
  for (std::uint32_t left = block_.faces[first]; left > 0; --left) end += block_.faces[end] + 1;
  return std::span(block_.faces).subspan(first + 1, end - first - 1);
}

/// Appends the splitter's result for a cell. Returns whether its tets overlap.
bool BlockCells::keep_filled(std::size_t c, PolyhedronSplitter& filled, BlockTets& out) const {
  const auto own = static_cast<std::uint32_t>(points_.size());
  const auto before = static_cast<std::uint32_t>(out.added.size());
  for (const glm::dvec3& p : filled.added()) out.added.push_back(p);
  if (association_ == scene::Association::point) filled.add_values(values_, out.added_values);
  const std::size_t first = out.tets.size();
  const bool overlap = keep_tets(
      c, filled.tets(), [&](std::uint32_t v) { return v < own ? points_[v] : out.added[before + (v - own)]; }, out);
  for (std::size_t t = first; t < out.tets.size() && before > 0; ++t)
    for (std::uint32_t& v : out.tets[t])
      if (v >= own) v += before;
  return overlap;
}

/// Whether a cell is left out because it is a ghost, hidden or not finite. Counts cells that are left out.
bool BlockCells::is_left_out(std::size_t c, std::span<const std::uint32_t> corner, BlockTets& out) const {
  const std::uint8_t ghost = block_.cell_ghost.empty() ? 0 : block_.cell_ghost[c];
  if (ghost & duplicate_cell)
    ++out.counts.cells_ghost;
  else if ((ghost & (hidden_cell | refined_cell)) || hides_a_point(corner))
    ++out.counts.cells_hidden;
  else if (!is_finite(corner, c))
    ++out.counts.cells_nan;
  else
    return false;
  return true;
}

/// Appends tets. Returns whether they overlap.
template <class PlaceOf>
bool BlockCells::keep_tets(std::size_t c, std::span<const Tet> cell_tets, const PlaceOf& place_of,
                           BlockTets& out) const {
  double positive = 0, negative = 0;
  for (const Tet& tet : cell_tets) {
    const glm::dvec3 a = place_of(tet[0]), b = place_of(tet[1]), p = place_of(tet[2]), q = place_of(tet[3]);
    // A tet with two coincident corners is flat: two of its faces are the same triangle and the other two have no area.
    // If the tet is dropped, its two neighbours still share a face.
    if (a == b || a == p || a == q || b == p || b == q || p == q) {
      ++out.counts.tets_collapsed;
      continue;
    }
    const double volume = glm::dot(glm::cross(b - a, p - a), q - a);
    (volume > 0 ? positive : negative) += std::abs(volume);
    out.tets.push_back(tet);
    out.cells.push_back(c);
  }
  if (positive + negative == 0) ++out.counts.cells_zero_volume;
  if (std::min(positive, negative) <= 1e-9 * (positive + negative)) return false;
  ++out.counts.cells_tangled;
  return true;
}

bool BlockCells::hides_a_point(std::span<const std::uint32_t> corner) const {
  return !block_.point_ghost.empty() && std::any_of(corner.begin(), corner.end(), [&](std::uint32_t v) {
    return block_.point_ghost[v] & hidden_point;
  });
}

bool BlockCells::is_finite(std::span<const std::uint32_t> corner, std::size_t c) const {
  const bool point = association_ == scene::Association::point;
  if (!point && !std::isfinite(values_[c])) return false;
  return std::all_of(corner.begin(), corner.end(), [&](std::uint32_t v) {
    return scene::finite(points_[v]) && (!point || std::isfinite(values_[v]));
  });
}

std::string BlockCells::place(std::size_t c) const {
  return block_.name.empty() ? fmt::format("cell {}", c) : fmt::format("block '{}', cell {}", block_.name, c);
}

}  // namespace tessera::cells
