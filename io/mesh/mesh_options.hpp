// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/read_options.hpp"

namespace tessera::io {

/// Options for reading a mesh file.
struct MeshOptions : ReadOptions {
  bool surfaces = false;  ///< also read and name blocks of faces, patches and side sets
};

}  // namespace tessera::io
