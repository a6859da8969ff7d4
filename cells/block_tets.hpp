// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"
#include "cells/cell_split.hpp"
#include "cells/curved/curved_cells.hpp"
#include "cells/field_summary.hpp"
#include "cells/polyhedron_split.hpp"

namespace tessera::cells {

/// The tets of some of a block's cells.
struct BlockTets {
  std::vector<scene::Tet> tets;      ///< corners: indices of the block's points, then of `added`
  std::vector<std::uint64_t> cells;  ///< for each tet, the index in the block of its cell
  std::vector<glm::dvec3> added;     ///< additional points at which cells are split
  std::vector<double> added_values;  ///< one value per added point; empty for cell data
  std::vector<std::uint32_t> nodes;  ///< nodes of the divided higher-order cells; few are corners of tets
  HigherOrderCells curved;
  MeshCounts counts;  ///< counts of cells only, not of points and tets
  std::exception_ptr error;
};

/// The cells of a block: which of them are kept, and into which tets they are split. Several threads may split
/// different cells of the block in parallel.
class BlockCells {
 public:
  /// `points` and `values` are those of the block; `association` determines whether the values are those of points or
  /// of cells. `source` is for messages. All arguments must outlive this object. `before` counts the tets of cells of
  /// other blocks.
  BlockCells(const CellBlock& block, std::span<const glm::dvec3> points, std::span<const double> values,
             scene::Association association, const std::string& source, const CurvedSettings& curved = {},
             const HigherOrderCells& before = {});

  [[nodiscard]] std::size_t count() const { return block_.cell_count(); }
  /// Whether any cells are higher-order cells, each of which is divided into many tets.
  [[nodiscard]] bool divides() const { return curved_.any(); }

  /// Splits the cells [first, last); overwrites `out`. Throws Error(bad_input) for a cell that cannot be split.
  void split(std::size_t first, std::size_t last, BlockTets& out) const;

 private:
  /// Scratch memory that is reused from cell to cell.
  struct SplitScratch {
    std::vector<scene::Tet> tets;
    std::vector<std::uint32_t> faces, corners;
    PolyhedronSplitter polyhedra;
    CurvedWork curved;
  };
  void split_cell(std::size_t c, SplitScratch& work, BlockTets& out) const;
  void split_curved(std::size_t c, SplitScratch& work, BlockTets& out) const;
  void split_polyhedron(std::size_t c, CellKind kind, SplitScratch& work, BlockTets& out) const;
  bool keep_filled(std::size_t c, PolyhedronSplitter& filled, BlockTets& out) const;
  bool is_left_out(std::size_t c, std::span<const std::uint32_t> corner, BlockTets& out) const;
  template <class PlaceOf>
  bool keep_tets(std::size_t c, std::span<const scene::Tet> cell_tets, const PlaceOf& place_of, BlockTets& out) const;
  [[nodiscard]] std::span<const std::uint32_t> faces_of(std::size_t c) const;
  [[nodiscard]] bool hides_a_point(std::span<const std::uint32_t> corner) const;
  [[nodiscard]] bool is_finite(std::span<const std::uint32_t> corner, std::size_t c) const;
  [[nodiscard]] std::string place(std::size_t c) const;

  const CellBlock& block_;
  std::span<const glm::dvec3> points_;
  std::span<const double> values_;
  scene::Association association_;
  const std::string& source_;
  std::array<CellShape, 256> shapes_;
  CurvedCells curved_;
  std::uint64_t most_curved_tets_;  ///< largest number of tets of the curved cells
  mutable std::atomic<std::uint64_t> curved_tets_{0};
};

}  // namespace tessera::cells
