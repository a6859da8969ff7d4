// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Parsers for the text files of an AMReX plot file.
namespace tessera::io {

/// A box of cells of one level, from the first to the last cell along each axis, both included.
struct AmrexBox {
  std::array<std::int64_t, 3> low{}, high{};

  /// Number of cells along an axis.
  [[nodiscard]] std::int64_t cells(std::size_t axis) const { return high[axis] - low[axis] + 1; }
};

/// A level of a plot file.
struct AmrexLevel {
  AmrexBox domain;
  std::array<double, 3> spacing{};
  std::string cells;  ///< path of the level's list of boxes, for example Level_0/Cell
};

/// The file Header of a plot file: a text with the values of these members, in this order.
struct AmrexHeader {
  std::vector<std::string> fields;
  std::array<double, 3> low{};  ///< lowest corner of the domain of the coarsest level
  std::vector<AmrexLevel> levels;
};

/// The values of one box: a line of text, then all cells of the first field, x fastest, then those of the next field.
/// The values may include cells around the box.
struct AmrexFab {
  AmrexBox box, stored;
  std::string file;
  std::uint64_t offset = 0;  ///< position of the line of text
};

/// The parsing functions throw Error(bad_input) that names the line at fault.
AmrexHeader parse_amrex_header(std::string_view text, const std::string& source);
std::vector<AmrexFab> parse_amrex_level(std::string_view text, std::size_t fields, const std::string& source);

/// Parses the end of the line that precedes the values: the box of the values and the number of fields.
AmrexBox parse_amrex_fab(std::string_view text, std::size_t& fields, const std::string& source);

}  // namespace tessera::io
