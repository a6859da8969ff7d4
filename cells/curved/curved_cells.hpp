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
  std::size_t limit = 0;  ///< largest number of tets for one cell; 0: no cell is divided
  /// Largest number of tets for all cells together, in addition to 64 for each cell.
  std::uint64_t all = std::numeric_limits<std::uint64_t>::max() / 2;
  /// The user set `limit`; it then also applies to cells of high order, which take longer.
  bool is_chosen = false;
};

/// Scratch memory of a thread, reused from cell to cell.
struct CurvedWork {
  explicit CurvedWork(const CurvedTolerance& tolerance) : splitter(tolerance) {}
  CurvedSplitter splitter;
  std::vector<glm::dvec3> positions;
  std::vector<double> values, weights;
  std::vector<scene::Tet> first;  ///< tets between the corners, in the cell's node numbers
};

/// The higher-order cells of a block that can be divided. Threads may process different cells in parallel.
class CurvedCells {
 public:
  CurvedCells(const CellBlock& block, std::span<const glm::dvec3> points, std::span<const double> values,
              scene::Association association, const CurvedSettings& settings);

  [[nodiscard]] bool any() const { return !lattices_.empty(); }

  /// Returns the lattice of a cell. Null if the cell is linear or of a kind that is drawn by its corners. The latter
  /// includes Bezier cells with weights that are not positive or differ by a factor of more than 10^6.
  [[nodiscard]] const CurvedLattice* lattice(std::size_t cell) const;

  /// Divides a cell that has a lattice; the result is in work.splitter. Throws std::length_error for more than
  /// settings().limit tets.
  void split(std::size_t cell, CurvedWork& work) const;

  /// Calls `report` for each initial tet of all cells, with the deviation of its edges as a multiple of the tolerance.
  void tally_excess(const std::function<void(double excess)>& report) const;

  /// Whether the cells become more tets than the settings allow. Determined by dividing the cells.
  [[nodiscard]] bool take_too_many() const;

  [[nodiscard]] const CurvedSettings& settings() const { return settings_; }

 private:
  using Key = std::pair<std::size_t, std::array<int, 4>>;  ///< number of nodes, degrees and type
  [[nodiscard]] Key key_of(std::size_t cell) const;
  [[nodiscard]] std::span<const std::uint32_t> nodes_of(std::size_t cell) const;
  [[nodiscard]] bool has_usable_weights(std::size_t cell) const;
  void begin(std::size_t cell, CurvedWork& work) const;
  [[nodiscard]] static bool is_finite(const CurvedWork& work);

  const CellBlock& block_;
  std::span<const glm::dvec3> points_;
  std::span<const double> values_;  ///< empty for cell data
  CurvedSettings settings_;
  std::vector<std::array<int, 3>> degrees_;  ///< per cell, or empty
  std::vector<double> weights_;              ///< per point, or empty
  std::map<Key, CurvedLattice> lattices_;
};

/// Whether the block has cells to be divided.
bool has_curved_cells(const CellBlock& block);

}  // namespace tessera::cells
