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

/// Element sets of an Exodus file: lists of its elements, which are counted from 1 over all blocks. They are chosen by
/// name as blocks are; node sets, which hold no cells, are refused, and so are side sets, faces of elements, unless
/// they are asked for.
class ExodusSets {
 public:
  /// Of an open file; lists hold at most `most_values`. `fail` throws an error that says what is wrong with it. Throws
  /// Error(bad_input) that begins with `source` for a choice that means a side set or a node set.
  ExodusSets(int id, const ex_init_params& init, const cells::BlockChoice& choice, std::uint64_t most_values,
             const std::string& source, const std::function<void(const std::string&)>& fail, bool with_sides);

  /// Of all element sets, and of side sets if asked for, those too that were not chosen; without a name
  /// `element set ID`, `side set ID`.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  /// Which of the elements [first, first + count), from 0, are in chosen sets: numbers from 0 to count - 1, ascending.
  [[nodiscard]] std::vector<std::uint64_t> chosen_of(std::uint64_t first, std::uint64_t count) const;

  /// Names of the side sets that were not asked for.
  [[nodiscard]] const std::vector<std::string>& sides_left_out() const { return sides_left_out_; }

  /// Ids of the chosen side sets.
  [[nodiscard]] const std::vector<std::int64_t>& sides() const { return sides_; }

 private:
  std::vector<std::string> names_, sides_left_out_;
  std::vector<std::int64_t> sides_;
  std::vector<std::uint64_t> elements_;  ///< of the chosen sets, from 0, ascending, each once
};

/// The name of an entity of the file, empty if it has none.
std::string exodus_name(int file, ex_entity_type type, std::int64_t id);

/// An element block as side sets need it.
struct SidesOf {
  std::int64_t id = 0, nodes = 0;  ///< of an element
  std::uint64_t end = 0;           ///< the number of elements in the file's blocks up to this one
  std::string topology{};          ///< in upper case
};

/// Adds the faces of a side set as polygons of their corners (VTK's type 7). `points` of the file, `sets` at most as
/// many as `most_values`; `fail` as above. `blocks` are the file's element blocks in its order: the corners of solids'
/// sides are found by them, since the library knows not all types; of others it lists the nodes.
void add_sides(int file, std::int64_t id, std::int64_t points, std::uint64_t most_values,
               const std::function<void(const std::string&)>& fail, std::span<const SidesOf> blocks,
               cells::CellBlock& block);

/// Leaves of a block's cells from `first` on those with the numbers `kept`, counted from `first`, ascending.
void keep_cells(cells::CellBlock& block, std::size_t first, const std::vector<std::uint64_t>& kept);

}  // namespace tessera::readers
