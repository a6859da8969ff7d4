// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Parsers for the text files of an AMReX plot file.
namespace tessera::io {

/// The cells of one level from the first to the last along each axis, both included.
struct AmrexBox {
  std::array<std::int64_t, 3> low{}, high{};

  /// Number of cells along an axis.
  [[nodiscard]] std::int64_t cells(std::size_t axis) const { return high[axis] - low[axis] + 1; }
};

/// A level of a plot file.
struct AmrexLevel {
  AmrexBox domain;
  std::array<double, 3> spacing{};
  std::string cells;  ///< path of its list of boxes: Level_0/Cell
};

/// The Header of a plot file: text, in the order of these members.
struct AmrexHeader {
  std::vector<std::string> fields;
  std::array<double, 3> low{};  ///< of the domain of the coarsest level
  std::vector<AmrexLevel> levels;
};

/// The values of one box: a line of text, then all cells of the first field, x fastest, then the next field. They may
/// also cover cells around the box.
struct AmrexFab {
  AmrexBox box, stored;
  std::string file;
  std::uint64_t offset = 0;  ///< of that line
};

/// These functions throw Error(bad_input) naming the line at fault.
AmrexHeader parse_amrex_header(std::string_view text, const std::string& source);
std::vector<AmrexFab> parse_amrex_level(std::string_view text, std::size_t fields, const std::string& source);

/// Parses the end of the line before values: their box and the number of fields.
AmrexBox parse_amrex_fab(std::string_view text, std::size_t& fields, const std::string& source);

}  // namespace tessera::io
