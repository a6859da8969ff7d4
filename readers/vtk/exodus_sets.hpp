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

/// Element sets of an Exodus file: lists of its elements, which are numbered from 1 over all blocks. They are chosen by
/// name like blocks. Node sets, which contain no cells, are refused; so are side sets, which are faces of elements,
/// unless they are requested.
class ExodusSets {
 public:
  /// For an open file; lists have at most `most_values`. `fail` throws an error about the file. Throws Error(bad_input)
  /// that begins with `source` for a choice that selects a side set or a node set.
  ExodusSets(int id, const ex_init_params& init, const cells::BlockChoice& choice, std::uint64_t most_values,
             const std::string& source, const std::function<void(const std::string&)>& fail, bool with_sides);

  /// Names of all element sets, and of side sets if requested, including those not chosen; without a name `element set
  /// ID`, `side set ID`.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  /// The elements of [first, first + count), from 0, that are in chosen sets: numbers from 0 to count - 1, ascending.
  [[nodiscard]] std::vector<std::uint64_t> chosen_of(std::uint64_t first, std::uint64_t count) const;

  /// Names of the side sets that were not requested.
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

/// The properties of an element block that side sets need.
struct SidesOf {
  std::int64_t id = 0, nodes = 0;  ///< nodes: per element
  std::uint64_t end = 0;           ///< number of elements in the file's blocks up to and including this one
  std::string topology{};          ///< in upper case
};

/// Adds the faces of a side set as polygons of their corners (VTK's type 7). `points`: of the file; `sets`: at most as
/// many as `most_values`; `fail` as above. `blocks` are the file's element blocks in order: they supply the corners of
/// solids' sides, because the library does not support all types; for others it lists the nodes.
void add_sides(int file, std::int64_t id, std::int64_t points, std::uint64_t most_values,
               const std::function<void(const std::string&)>& fail, std::span<const SidesOf> blocks,
               cells::CellBlock& block);

/// Of a block's cells from `first` on, keeps only those with the indices `kept`, counted from `first`, ascending.
void keep_cells(cells::CellBlock& block, std::size_t first, const std::vector<std::uint64_t>& kept);

}  // namespace tessera::readers
