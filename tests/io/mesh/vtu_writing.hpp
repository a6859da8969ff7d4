// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tessera::test {

/// How the arrays of a .vtu are stored.
struct VtuStorage {
  enum class Coding : std::uint8_t { ascii, inline_base64, appended_base64, appended_raw };
  enum class Codec : std::uint8_t { none, zlib, lz4, lzma };

  Coding coding = Coding::ascii;
  Codec codec = Codec::none;
  bool wide_numbers = false;  ///< header_type UInt64
  bool big_endian = false;
  std::size_t block = 40;   ///< bytes of a compressed block; 0: the whole array
  bool split_text = false;  ///< base64: the number of bytes is a separate text
  std::size_t line = 0;     ///< base64: characters per line; 0: all in one
  std::string version = "1.0";
};

/// An array and its numbers, as far as doubles represent them.
struct VtuArray {
  std::string type, name;
  int components = 1;
  std::vector<double> numbers;
};

struct VtuPiece {
  std::size_t points = 0, cells = 0;
  std::vector<VtuArray> point_data{}, cell_data{}, coordinates{}, topology{};
  /// Attributes of <PointData> and <CellData>, such as `Scalars="f"`.
  std::string point_attributes{}, cell_attributes{};
};

/// The text of a file.
std::string vtu_file_text(const VtuStorage& storage, const std::vector<VtuPiece>& pieces);

/// Two cubes with 12 points in total: a hexahedron, and two wedges that fill the second cube. They have the point field
/// "f", the vectors "v", the cell field "c", points of `point_type` and indices of `index_type`.
VtuPiece sample_piece(const std::string& point_type = "Float64", const std::string& index_type = "Int64",
                      const std::string& cell_type = "UInt8");

/// All storage variants: four encodings, four codecs (none for ascii), two widths, two byte orders.
std::vector<VtuStorage> all_storages();

}  // namespace tessera::test
