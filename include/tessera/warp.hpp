// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tessera {
inline namespace v0_1 {

/// How the points of a mesh are moved: each by a vector of the file, multiplied by a factor.
struct Warp {
  std::string vector{};  ///< name of the point data with the vectors, three components; empty: points are not moved
  double factor = 1;     ///< factor of the vectors, finite

  bool operator==(const Warp&) const = default;
};

}  // namespace v0_1
}  // namespace tessera
