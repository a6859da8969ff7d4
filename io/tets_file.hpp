#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scene/tet_mesh.hpp"

namespace tessera::io {

/// Parses the `.tets` format: raw little endian int64 nverts, int64 ntets, float32 xyz[3 nverts], float32
/// scalar[nverts], int32 tets[4 ntets], and nothing after that.
///
/// The sizes are checked against the bytes present before anything is allocated, every index against nverts. Numbers
/// may be NaN: blanking is the caller's. Throws Error(bad_input, "SOURCE: ...").
scene::TetMesh parse_tets(std::span<const std::byte> bytes, const std::string& source);

}  // namespace tessera::io
