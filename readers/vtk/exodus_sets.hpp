// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtk_exodusII.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cells/block_choice.hpp"
#include "cells/cell_block.hpp"

namespace tessera::readers {

/// The element sets of an Exodus file, which are lists of elements; elements are numbered from 1 over all blocks.
/// Element sets are chosen by name like blocks. Node sets contain no cells and cannot be chosen. Side sets contain
/// faces of elements and can be chosen only if they are requested.
class ExodusSets {
 public:
  /// Reads the sets of an open file. Lists have at most `most_values` values. `fail` throws an error about the file.
  /// Throws Error(bad_input) that begins with `source` for a choice that selects a side set or a node set.
  ExodusSets(int id, const ex_init_params& init, const cells::BlockChoice& choice, std::uint64_t most_values,
             const std::string& source, const std::function<void(const std::string&)>& fail, bool with_sides);

  /// Names of all element sets, and of side sets if requested, including those that are not chosen. A set without a
  /// name is named `element set ID` or `side set ID`.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  /// Returns which of the elements [first, first + count), counted from 0, are in chosen sets: numbers from 0 to count
  /// - 1, ascending.
  [[nodiscard]] std::vector<std::uint64_t> chosen_of(std::uint64_t first, std::uint64_t count) const;

  /// Names of the side sets that were not requested.
  [[nodiscard]] const std::vector<std::string>& sides_left_out() const { return sides_left_out_; }

  /// Ids of the chosen side sets.
  [[nodiscard]] const std::vector<std::int64_t>& sides() const { return sides_; }

 private:
  std::vector<std::string> names_, sides_left_out_;
  std::vector<std::int64_t> sides_;
  std::vector<std::uint64_t> elements_;  ///< elements of the chosen sets, counted from 0, ascending, each once
};

/// Returns the name of an entity of the file; empty if it has none.
std::string exodus_name(int file, ex_entity_type type, std::int64_t id);

/// Properties of an element block, which are needed to read side sets.
struct SidesOf {
  std::int64_t id = 0, nodes = 0;  ///< `nodes`: per element
  std::uint64_t end = 0;           ///< number of elements in this block and all blocks before it
  std::string topology{};          ///< topology in upper case
};

/// Adds the faces of a side set as polygons of their corners (VTK's type 7). `points` is the number of points of the
/// file; a set has at most `most_values` entries; `fail` is as in ExodusSets. `blocks` are the element blocks of the
/// file in order. They determine the corners of the sides of solids, because the library does not support all types;
/// for other elements, the library lists the nodes.
void add_sides(int file, std::int64_t id, std::int64_t points, std::uint64_t most_values,
               const std::function<void(const std::string&)>& fail, std::span<const SidesOf> blocks,
               cells::CellBlock& block);

/// Keeps only the cells with the indices `kept` among the cells of a block from `first` on. The indices are counted
/// from `first` and ascending.
void keep_cells(cells::CellBlock& block, std::size_t first, const std::vector<std::uint64_t>& kept);

}  // namespace tessera::readers
