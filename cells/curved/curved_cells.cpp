// SPDX-License-Identifier: BSD-3-Clause
#include "cells/curved/curved_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "cells/cell_split.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::cells {
namespace {

bool is_bezier(std::uint8_t number) {
  const CellType type{number};
  return type >= CellType::bezier_tetrahedron && type <= CellType::bezier_wedge;
}
/// Whether HigherOrderDegrees may define the orders of this type.
bool has_degrees(std::uint8_t number) {
  const CellType type{number};
  return (type >= CellType::lagrange_tetrahedron && type <= CellType::lagrange_wedge) || is_bezier(number);
}
bool is_curved(std::uint8_t number) {
  const CellType type{number};
  return (type >= CellType::quadratic_tetra && type <= CellType::quadratic_pyramid) ||
         type == CellType::triquadratic_hexahedron ||
         (type >= CellType::quadratic_linear_wedge && type <= CellType::biquadratic_quadratic_hexahedron) ||
         type == CellType::triquadratic_pyramid || type == CellType::lagrange_pyramid || has_degrees(number);
}

/// Largest ratio of weights within one cell. Beyond it, values with the smallest weight keep only a few bits.
constexpr double most_weight_ratio = 1e6;

/// Returns VTK's point array of rational weights of Bezier cells; empty if there is none.
std::vector<double> weights_in(const CellBlock& block, std::size_t points) {
  std::vector<double> weights;
  for (const BlockField& field : block.fields) {
    if (field.name != "RationalWeights" || field.association != scene::Association::point || field.components != 1 ||
        field.tuples != points)
      continue;
    weights.resize(points);
    field.read(0, 0, weights);
    break;
  }
  return weights;
}

/// Returns VTK's cell array of the orders of Lagrange and Bezier cells; empty if there is none.
std::vector<std::array<int, 3>> degrees_in(const CellBlock& block) {
  std::vector<std::array<int, 3>> degrees;
  for (const BlockField& field : block.fields) {
    if (field.name != "HigherOrderDegrees" || field.association != scene::Association::cell || field.components != 3 ||
        field.tuples != block.cell_count())
      continue;
    degrees.resize(field.tuples);
    std::vector<double> numbers(field.tuples);
    for (int c = 0; c < 3; ++c) {
      field.read(c, 0, numbers);
      for (std::size_t k = 0; k < numbers.size(); ++k)
        degrees[k][static_cast<std::size_t>(c)] =
            numbers[k] >= 1 && numbers[k] < 1000 ? static_cast<int>(numbers[k]) : 0;
    }
    break;
  }
  return degrees;
}

}  // namespace

constexpr std::size_t enough_of_a_cell = 3 << 17;  // number of tets that is enough even for a small mesh

bool has_curved_cells(const CellBlock& block) { return std::any_of(block.types.begin(), block.types.end(), is_curved); }

CurvedCells::CurvedCells(const CellBlock& block, std::span<const glm::dvec3> points, std::span<const double> values,
                         scene::Association association, const CurvedSettings& settings)
    : block_(block),
      points_(points),
      values_(association == scene::Association::point ? values : std::span<const double>{}),
      settings_(settings) {
  if (settings.limit == 0 || !has_curved_cells(block)) return;
  if (std::any_of(block.types.begin(), block.types.end(), has_degrees)) degrees_ = degrees_in(block);
  if (std::any_of(block.types.begin(), block.types.end(), is_bezier)) weights_ = weights_in(block, points.size());
  for (std::size_t c = 0; c < block.types.size(); ++c) {
    if (!is_curved(block.types[c])) continue;
    const Key key = key_of(c);
    if (lattices_.contains(key)) continue;
    const auto& [nodes, degrees] = key;
    if (std::optional<CurvedLattice> made = curved_lattice(block.types[c], nodes, {degrees[0], degrees[1], degrees[2]}))
      lattices_.emplace(key, std::move(*made));
  }
  // Bounds the time for a cell that needs far more tets than others, for example in a damaged file.
  double cost = 1;
  for (const auto& [key, made] : lattices_) cost = std::max(cost, cost_of_tet(made));
  if (!settings_.is_chosen && cost > 1 && settings_.limit > enough_of_a_cell)
    settings_.limit = std::max(enough_of_a_cell, static_cast<std::size_t>(static_cast<double>(settings_.limit) / cost));
}

CurvedCells::Key CurvedCells::key_of(std::size_t cell) const {
  const std::uint8_t type = block_.types[cell];
  const std::array<int, 3> degrees = degrees_.empty() || !has_degrees(type) ? std::array<int, 3>{} : degrees_[cell];
  return {block_.offsets[cell + 1] - block_.offsets[cell], {degrees[0], degrees[1], degrees[2], type}};
}

const CurvedLattice* CurvedCells::lattice(std::size_t cell) const {
  if (lattices_.empty() || !is_curved(block_.types[cell])) return nullptr;
  const auto found = lattices_.find(key_of(cell));
  return found == lattices_.end() || !has_usable_weights(cell) ? nullptr : &found->second;
}

bool CurvedCells::has_usable_weights(std::size_t cell) const {
  if (weights_.empty() || !is_bezier(block_.types[cell])) return true;
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const std::uint32_t v : nodes_of(cell)) {
    if (!(weights_[v] > 0) || !std::isfinite(weights_[v])) return false;
    low = std::min(low, weights_[v]), high = std::max(high, weights_[v]);
  }
  return high <= most_weight_ratio * low;
}

std::span<const std::uint32_t> CurvedCells::nodes_of(std::size_t cell) const {
  return std::span(block_.connectivity).subspan(block_.offsets[cell], block_.offsets[cell + 1] - block_.offsets[cell]);
}

/// Copies the cell's nodes, and the tets between its corners.
void CurvedCells::begin(std::size_t cell, CurvedWork& work) const {
  work.positions.clear(), work.values.clear(), work.weights.clear(), work.first.clear();
  const bool is_weighted = !weights_.empty() && is_bezier(block_.types[cell]);
  for (const std::uint32_t v : nodes_of(cell)) {
    work.positions.push_back(points_[v]);
    if (!values_.empty()) work.values.push_back(values_[v]);
    if (is_weighted) work.weights.push_back(weights_[v]);
  }
  static constexpr std::array<std::uint32_t, 8> numbers = {0, 1, 2, 3, 4, 5, 6, 7};
  const CellShape shape = cell_shape(block_.types[cell]);
  const auto same = [&](double w) { return w == work.weights.front(); };
  if (std::all_of(work.weights.begin(), work.weights.end(), same)) work.weights.clear();
  split_cell(shape.kind, std::span(numbers).first(static_cast<std::size_t>(shape.corners)), work.positions, work.first);
}

void CurvedCells::split(std::size_t cell, CurvedWork& work) const {
  begin(cell, work);
  work.splitter.split(*lattice(cell), work.positions, work.values, work.weights, work.first, settings_.limit);
}

bool CurvedCells::is_finite(const CurvedWork& work) {
  return std::all_of(
             work.positions.begin(), work.positions.end(),
             [](const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }) &&
         std::all_of(work.values.begin(), work.values.end(), [](double v) { return std::isfinite(v); });
}

bool CurvedCells::take_too_many() const {
  CurvedWork work(settings_.tolerance);
  std::uint64_t tets = 0;
  for (std::size_t c = 0; c < block_.types.size() && !lattices_.empty(); ++c) {
    if (lattice(c) == nullptr) continue;
    begin(c, work);
    if (!is_finite(work)) continue;
    try {
      split(c, work);
    } catch (const std::length_error&) {
      return true;
    }
    tets += work.splitter.tets().size();
    if (tets > settings_.all) return true;
  }
  return false;
}

void CurvedCells::tally_excess(const std::function<void(double)>& report) const {
  CurvedWork work(settings_.tolerance);
  for (std::size_t c = 0; c < block_.types.size() && !lattices_.empty(); ++c) {
    const CurvedLattice* const curved = lattice(c);
    if (curved == nullptr) continue;
    begin(c, work);
    if (is_finite(work))
      work.splitter.tally_excess(*curved, work.positions, work.values, work.weights, work.first, report);
  }
}

}  // namespace tessera::cells
