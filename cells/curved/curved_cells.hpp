// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "cells/cell_block.hpp"
#include "cells/curved/curved_lattice.hpp"
#include "cells/curved/curved_split.hpp"
#include "cells/field_summary.hpp"

namespace tessera::cells {

/// How the higher-order cells of a mesh are divided.
struct CurvedSettings {
  CurvedTolerance tolerance;
  std::size_t limit = 0;  ///< tets that one cell may become; 0: none is divided
  /// Tets that all cells may become, beside 64 of each.
  std::uint64_t all = std::numeric_limits<std::uint64_t>::max() / 2;
  /// `limit` is a user's, and holds for cells of high order too, which take longer.
  bool is_chosen = false;
};

/// What a thread needs to divide them, of one cell after another.
struct CurvedWork {
  explicit CurvedWork(const CurvedTolerance& tolerance) : splitter(tolerance) {}
  CurvedSplitter splitter;
  std::vector<glm::dvec3> positions;
  std::vector<double> values, weights;
  std::vector<scene::Tet> first;  ///< of the corners, numbered in the cell
};

/// The higher-order cells of a block that can be divided. Threads may ask for different ones at once.
class CurvedCells {
 public:
  CurvedCells(const CellBlock& block, std::span<const glm::dvec3> points, std::span<const double> values,
              scene::Association association, const CurvedSettings& settings);

  [[nodiscard]] bool any() const { return !lattices_.empty(); }

  /// Null if the cell is no higher-order one or of a kind that is drawn by its corners, as are Bezier cells of weights
  /// that are not positive or more than a factor of 10^6 apart.
  [[nodiscard]] const CurvedLattice* lattice(std::size_t cell) const;

  /// Divides a cell that has a lattice: work.splitter has the result. Throws std::length_error for more than
  /// settings().limit tets.
  void split(std::size_t cell, CurvedWork& work) const;

  /// Says of each first tet of all cells how far its edges are off, in tolerances.
  void tally_excess(const std::function<void(double excess)>& say) const;

  /// Whether the cells become more tets than the settings let them, found by dividing them.
  [[nodiscard]] bool take_too_many() const;

  [[nodiscard]] const CurvedSettings& settings() const { return settings_; }

 private:
  using Key = std::pair<std::size_t, std::array<int, 4>>;  ///< number of nodes, degrees, type
  [[nodiscard]] Key key_of(std::size_t cell) const;
  [[nodiscard]] std::span<const std::uint32_t> nodes_of(std::size_t cell) const;
  [[nodiscard]] bool has_usable_weights(std::size_t cell) const;
  void begin(std::size_t cell, CurvedWork& work) const;
  [[nodiscard]] static bool is_finite(const CurvedWork& work);

  const CellBlock& block_;
  std::span<const glm::dvec3> points_;
  std::span<const double> values_;  ///< none for cell data
  CurvedSettings settings_;
  std::vector<std::array<int, 3>> degrees_;  ///< of each cell, or none at all
  std::vector<double> weights_;              ///< of each point, or none at all
  std::map<Key, CurvedLattice> lattices_;
};

/// Whether the block has cells that are divided.
bool has_curved_cells(const CellBlock& block);

}  // namespace tessera::cells
