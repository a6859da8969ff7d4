// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "cells/surface.hpp"

namespace tessera::io {

/// Parses a PLY surface: ASCII or binary of either byte order, vertex x y z and face vertex_indices (or vertex_index);
/// other scalar vertex properties except colours, normals and texture coordinates become attributes, listed in
/// `attribute_names`. Every count is compared with the available bytes. Throws Error(bad_input, "SOURCE: ...").
struct PlySurface {
  cells::Surface surface;
  std::vector<std::string> attribute_names;
};
PlySurface parse_ply(std::string_view text, const std::string& source);

}  // namespace tessera::io
