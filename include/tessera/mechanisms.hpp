// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera {
inline namespace v0_1 {

/// What saves work and shows in no pixel by more than the accuracy asked. Each can be switched off, to see what it is
/// worth (`--without`; bench/needed.py makes the table).
struct Mechanisms {
  bool culling = true;      ///< cells and bricks of which the transfer function shows nothing are left out at once
  bool skipping = true;     ///< volumes: so are the 8^3 voxels of which it shows nothing, within bricks
  bool termination = true;  ///< a ray ends behind matter through which nothing would show
  bool lattice = true;      ///< meshes: 32-bit integer depths and float lanes where they are good enough
  bool sharing = true;      ///< meshes: ranks of one machine hold what they project in shared memory, and make whole
                            ///< tiles; else each projects its part into all
  friend bool operator==(const Mechanisms&, const Mechanisms&) = default;
};

}  // namespace v0_1
}  // namespace tessera
