// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtk_exodusII.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"

namespace tessera::readers {

/// The polyhedra of an Exodus file. They are elements of `nfaced` blocks; their faces are those of the file's face
/// blocks (`nsided`), which are numbered from 1 over all of these blocks.
class ExodusFaces {
 public:
  /// Prepares to read from an open file. Arrays have at most `most_values` values. `fail` throws an error about the
  /// file.
  ExodusFaces(int id, std::uint64_t most_values, std::function<void(const std::string&)> fail)
      : id_(id), most_values_(most_values), fail_(std::move(fail)) {}

  /// Adds the faces of the elements of a file's block; these elements are the last cells of `block`.
  void add(std::int64_t id, const ex_block& info, std::int64_t points, cells::CellBlock& block);

 private:
  /// The contents of an entity block: the length of each list, with sum `total`, and the numbers in all lists.
  struct Lists {
    std::vector<int> sizes;
    std::vector<std::int64_t> numbers;
  };
  [[nodiscard]] Lists read(ex_entity_type type, std::int64_t id, std::int64_t count, std::int64_t total) const;
  void read_faces();

  int id_;
  std::uint64_t most_values_;
  std::function<void(const std::string&)> fail_;
  bool has_read_ = false;
  std::vector<std::size_t> starts_;       ///< for each face, its start in `corners_`, plus one entry
  std::vector<std::int64_t> corners_;     ///< from 1
  std::vector<std::uint8_t> times_used_;  ///< per face
};

}  // namespace tessera::readers
