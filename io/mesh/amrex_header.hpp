// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// The texts of an AMReX plot file.
namespace tessera::io {

/// Cells of one level, by the first and last along each axis.
struct AmrexBox {
  std::array<std::int64_t, 3> low{}, high{};

  /// Cells along an axis.
  [[nodiscard]] std::int64_t cells(std::size_t axis) const { return high[axis] - low[axis] + 1; }
};

/// A level of a plot file.
struct AmrexLevel {
  AmrexBox domain;
  std::array<double, 3> spacing{};
  std::string cells;  ///< where its boxes are listed: Level_0/Cell
};

/// What the Header of a plot file says: text, one thing after the other.
struct AmrexHeader {
  std::vector<std::string> fields;
  std::array<double, 3> low{};  ///< of the coarsest level's domain
  std::vector<AmrexLevel> levels;
};

/// The values of one box: a line of text, then all cells of the first field, x first, and so on. They may be of more
/// cells than the box has, those beside it.
struct AmrexFab {
  AmrexBox box, stored;
  std::string file;
  std::uint64_t offset = 0;  ///< of its line
};

/// These throw Error(bad_input) naming the line at fault.
AmrexHeader parse_amrex_header(std::string_view text, const std::string& source);
std::vector<AmrexFab> parse_amrex_level(std::string_view text, std::size_t fields, const std::string& source);

/// The end of the line before values, as their box and how many fields there are.
AmrexBox parse_amrex_fab(std::string_view text, std::size_t& fields, const std::string& source);

}  // namespace tessera::io
