// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "cells/amr/amr_leaves.hpp"

namespace tessera::cells {

/// Distinct points of a lattice, numbered in the order of insertion. Open addressing, linear probing.
class AmrVertices {
 public:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] const AmrIndex& operator[](std::size_t id) const { return points_[id]; }

  /// Returns the number of a point; `none` if the point was not added.
  [[nodiscard]] std::uint32_t find(const AmrIndex& p) const;
  [[nodiscard]] bool has(const AmrIndex& p) const { return find(p) != none; }

  /// Returns the number of a point, after adding the point if it is new. Throws Error(bad_input) for more than 2^32 - 2
  /// points.
  std::uint32_t add(const AmrIndex& p);

 private:
  [[nodiscard]] std::size_t slot_of(const AmrIndex& p) const;
  void grow();

  std::vector<AmrIndex> points_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace tessera::cells
