// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/read_options.hpp"

namespace tessera::io {

/// Options for reading a mesh file.
struct MeshOptions : ReadOptions {
  bool surfaces = false;  ///< also read faces, patches and side sets as blocks, and list their names
};

}  // namespace tessera::io
