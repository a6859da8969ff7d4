// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tessera {
inline namespace v0_1 {

/// How the points of a mesh are moved, by a vector that its file has for each of them.
struct Warp {
  std::string vector{};  ///< point data of three components; empty: no point is moved
  double factor = 1;     ///< multiplies the vector; finite

  bool operator==(const Warp&) const = default;
};

}  // namespace v0_1
}  // namespace tessera
