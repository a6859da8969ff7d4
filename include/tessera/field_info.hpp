// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "tessera/association.hpp"

namespace tessera {
inline namespace v0_1 {

/// The field of ReadOptions::shape, which is no array of a file.
inline constexpr const char* shape_field_name = "shape (depth)";

/// One array of a file. Range and count are of all tuples, cells that were dropped included.
struct FieldInfo {
  std::string name;
  Association association = Association::point;
  int components = 1;
  std::string type;             ///< "float", "double", "int64", "uint8", ...
  double low = 0, high = 0;     ///< finite values, of the magnitude if there are several components; 0, 0 if none is
  std::uint64_t nan_count = 0;  ///< tuples that are NaN or infinite
  bool active = false;          ///< the file marks it as its scalars or vectors
  bool ids = false;             ///< it numbers cells or points: the file marks it so, or its values are 0 to n - 1 or
                                ///< 1 to n, each once (of integers from any number on)
  bool fractions = false;       ///< not all of its finite values are whole numbers

  bool operator==(const FieldInfo&) const = default;
};

}  // namespace v0_1
}  // namespace tessera
