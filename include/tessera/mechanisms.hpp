// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera {
inline namespace v0_1 {

/// Optimizations that change no pixel by more than the requested accuracy. Each can be switched off to measure its
/// effect (`--without`; bench/needed.py makes the table).
struct Mechanisms {
  bool culling = true;      ///< cells and bricks that the transfer function makes invisible are skipped as a whole
  bool skipping = true;     ///< volumes: so are invisible blocks of 8^3 voxels within bricks
  bool termination = true;  ///< a ray ends once nothing behind it could be visible
  bool lattice = true;      ///< meshes: 32-bit integer depths and float lanes where they are accurate enough
  bool sharing = true;      ///< meshes: ranks of one machine keep their projected cells in shared memory and make whole
                            ///< tiles; otherwise each projects its part into all tiles
  friend bool operator==(const Mechanisms&, const Mechanisms&) = default;
};

}  // namespace v0_1
}  // namespace tessera
