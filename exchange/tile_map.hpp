// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace tessera::exchange {

/// Assigns tiles to compositors: each sequence of P tiles in scanline order goes to the P compositors in a random order
/// of its own (Juliachs et al. 2007, section 3), which spreads neighbouring tiles, which tend to be equally full,
/// evenly. Seeded: the same on every rank and in every run. The image does not depend on it.
class TileMap {
 public:
  TileMap(std::size_t tiles, int compositors, std::uint64_t seed);

  /// Compositor (0 .. P-1, not its rank) of a tile.
  [[nodiscard]] int owner(std::size_t tile) const { return owners_[tile]; }
  /// Tiles of a compositor, in scanline order: the order in which every projector sends them.
  [[nodiscard]] const std::vector<std::uint32_t>& tiles(int compositor) const {
    return tiles_[static_cast<std::size_t>(compositor)];
  }
  [[nodiscard]] int compositors() const { return static_cast<int>(tiles_.size()); }
  [[nodiscard]] std::size_t size() const { return owners_.size(); }

 private:
  std::vector<int> owners_;
  std::vector<std::vector<std::uint32_t>> tiles_;
};

}  // namespace tessera::exchange
