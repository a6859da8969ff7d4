// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "tessera/association.hpp"

namespace tessera {
inline namespace v0_1 {

/// The name of the field of ReadOptions::shape, which is not an array of a file.
inline constexpr const char* shape_field_name = "shape (depth)";

/// An array of a file. `low`, `high` and `nan_count` refer to all tuples, including those of cells that were dropped.
struct FieldInfo {
  std::string name;
  Association association = Association::point;
  int components = 1;
  std::string type;             ///< "float", "double", "int64", "uint8", ...
  double low = 0, high = 0;     ///< range of the finite values, or of the magnitudes of vectors; 0 and 0 if there are
                                ///< none
  std::uint64_t nan_count = 0;  ///< tuples that are NaN or infinite
  bool active = false;          ///< the file marks it as active scalars or vectors
  bool ids = false;             ///< the array numbers cells or points: the file marks it as ids, or its values are n
                                ///< consecutive integers, each once; values of a non-integer type must begin with 0 or
                                ///< 1
  bool fractions = false;       ///< some finite values are not whole numbers

  bool operator==(const FieldInfo&) const = default;
};

}  // namespace v0_1
}  // namespace tessera
