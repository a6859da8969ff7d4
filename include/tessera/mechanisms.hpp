// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera {
inline namespace v0_1 {

/// Optimizations. None of them changes a pixel by more than the requested accuracy. Each can be switched off
/// (`--without`) to measure its effect; bench/needed.py prints a table of the effects.
struct Mechanisms {
  bool culling = true;      ///< cells and bricks that the transfer function makes invisible are skipped as a whole
  bool skipping = true;     ///< volumes: invisible blocks of 8^3 voxels within bricks are skipped
  bool termination = true;  ///< a ray ends once nothing behind it could be visible
  bool lattice = true;      ///< meshes: 32-bit integer depths and single precision are used where they are accurate
                            ///< enough
  bool sharing = true;      ///< meshes: ranks of one machine keep their projected cells in shared memory, and each
                            ///< computes whole tiles; otherwise each rank projects its part of the mesh into all tiles
  friend bool operator==(const Mechanisms&, const Mechanisms&) = default;
};

}  // namespace v0_1
}  // namespace tessera
