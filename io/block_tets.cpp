#include "io/block_tets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "scene/error.hpp"

namespace tessera::io {
namespace {

using scene::Tet;

// vtkDataSetAttributes.h: CellGhostTypes and PointGhostTypes.
constexpr std::uint8_t duplicate_cell = 1, refined_cell = 8, hidden_cell = 32, hidden_point = 2;
constexpr std::uint8_t tetra = 10;  // VTK's cell type number

bool finite(const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

BlockCells::BlockCells(const CellBlock& block, std::span<const glm::dvec3> points, std::span<const double> values,
                       scene::Association association, const std::string& source, const CurvedSettings& curved)
    : block_(block),
      points_(points),
      values_(values),
      association_(association),
      source_(source),
      curved_(block, points, values, association, curved) {
  for (std::size_t type = 0; type < shapes_.size(); ++type) shapes_[type] = cell_shape(static_cast<std::uint8_t>(type));
}

void BlockCells::split(std::size_t first, std::size_t last, BlockTets& out) const {
  out.tets.clear(), out.cells.clear();
  out.added.clear(), out.added_values.clear(), out.nodes.clear();
  out.counts = {};
  out.curved = {};
  out.error = nullptr;
  std::vector<Tet> cell_tets;
  CurvedWork work(curved_.settings().tolerance);
  for (std::size_t c = first; c < last; ++c) split_cell(c, work, cell_tets, out);
  out.counts.cells_read = last - first;
}

void BlockCells::split_cell(std::size_t c, CurvedWork& work, std::vector<Tet>& cell_tets, BlockTets& out) const {
  const bool all_tets = block_.types.empty();
  const std::uint8_t type = all_tets ? tetra : block_.types[c];
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
  if (shape.nodes ? nodes != static_cast<std::size_t>(shape.nodes) : nodes < static_cast<std::size_t>(shape.corners))
    throw scene::bad_input(fmt::format("{}: {} is a {} with {} nodes, it has to have {}; mend the cell types", source_,
                                       place(c), cell_type_name(type), nodes,
                                       shape.nodes ? shape.nodes : shape.corners));
  const std::uint8_t ghost = block_.cell_ghost.empty() ? 0 : block_.cell_ghost[c];
  if (ghost & duplicate_cell) {
    ++out.counts.cells_ghost;
    return;
  }
  const std::uint32_t* const first = all_tets ? block_.tets[c].data() : &block_.connectivity[block_.offsets[c]];
  const bool is_curved = shape.higher_order && curved_.lattice(c) != nullptr;
  const std::span<const std::uint32_t> corner(first, is_curved ? nodes : static_cast<std::size_t>(shape.corners));
  if ((ghost & (hidden_cell | refined_cell)) || hides_a_point(corner)) {
    ++out.counts.cells_hidden;
    return;
  }
  if (!is_finite(corner, c)) {
    ++out.counts.cells_nan;
    return;
  }
  if (shape.higher_order) ++out.counts.cells_quadratic;
  if (is_curved) return split_curved(c, work, cell_tets, out);
  if (shape.higher_order) ++out.curved.by_corners;
  cell_tets.clear();
  io::split_cell(shape.kind, corner, points_, cell_tets);
  keep_tets(c, cell_tets, out);
}

void BlockCells::split_curved(std::size_t c, CurvedWork& work, std::vector<Tet>& cell_tets, BlockTets& out) const {
  try {
    curved_.split(c, work);
  } catch (const std::length_error&) {
    throw scene::bad_input(
        fmt::format("{}: {} takes more than {} tets to come near to it; allow a larger difference "
                    "(`higher_order_tolerance`)",
                    source_, place(c), curved_.settings().limit));
  }
  const CurvedSplitter& split = work.splitter;
  const std::uint32_t* const node = &block_.connectivity[block_.offsets[c]];
  out.nodes.insert(out.nodes.end(), node, &block_.connectivity[0] + block_.offsets[c + 1]);
  const auto corners = static_cast<std::uint32_t>(split.corners());
  const auto first_added = static_cast<std::uint32_t>(points_.size() + out.added.size());
  for (const glm::dvec4& point : split.added()) {
    out.added.emplace_back(point.x, point.y, point.z);
    if (association_ == scene::Association::point) out.added_values.push_back(point.w);
  }
  cell_tets.clear();
  for (const Tet& tet : split.tets()) {
    Tet& made = cell_tets.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) made[k] = tet[k] < corners ? node[tet[k]] : first_added + (tet[k] - corners);
  }
  out.curved.divided += 1;
  out.curved.tets += cell_tets.size();
  out.curved.position_error = std::max(out.curved.position_error, split.error().position);
  out.curved.field_error = std::max(out.curved.field_error, split.error().field);
  keep_tets(c, cell_tets, out);
}

void BlockCells::keep_tets(std::size_t c, std::span<const Tet> cell_tets, BlockTets& out) const {
  double positive = 0, negative = 0;
  const auto point = [&](std::uint32_t v) { return v < points_.size() ? points_[v] : out.added[v - points_.size()]; };
  for (const Tet& tet : cell_tets) {
    const glm::dvec3 a = point(tet[0]), b = point(tet[1]), p = point(tet[2]), q = point(tet[3]);
    // A tet with two corners at one place is flat, two of its faces are the same triangle and the other two have no
    // area: leaving it out puts its two neighbours face to face.
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
  if (std::min(positive, negative) > 1e-9 * (positive + negative)) ++out.counts.cells_tangled;
}

bool BlockCells::hides_a_point(std::span<const std::uint32_t> corner) const {
  return !block_.point_ghost.empty() && std::any_of(corner.begin(), corner.end(), [&](std::uint32_t v) {
    return block_.point_ghost[v] & hidden_point;
  });
}

bool BlockCells::is_finite(std::span<const std::uint32_t> corner, std::size_t c) const {
  const bool point = association_ == scene::Association::point;
  if (!point && !std::isfinite(values_[c])) return false;
  return std::all_of(corner.begin(), corner.end(),
                     [&](std::uint32_t v) { return finite(points_[v]) && (!point || std::isfinite(values_[v])); });
}

std::string BlockCells::place(std::size_t c) const {
  return block_.name.empty() ? fmt::format("cell {}", c) : fmt::format("block '{}', cell {}", block_.name, c);
}

}  // namespace tessera::io
