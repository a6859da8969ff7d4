// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/read_options.hpp"

namespace tessera::io {

/// What is read of a mesh file.
struct MeshOptions : ReadOptions {
  bool surfaces = false;  ///< blocks of faces, patches and side sets are read and named too
};

}  // namespace tessera::io
