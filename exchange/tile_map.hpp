// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace tessera::exchange {

/// Assigns tiles to compositors: in scanline order, each group of P successive tiles goes to the P compositors in a
/// random order, chosen separately for each group (Juliachs et al. 2007, section 3). This spreads neighbouring tiles,
/// which tend to be equally full, evenly. The random order is determined by a seed, and is the same on every rank and
/// in every run. The image does not depend on it.
class TileMap {
 public:
  TileMap(std::size_t tiles, int compositors, std::uint64_t seed);

  /// The compositor of a tile, as a number 0 .. P-1 (not a rank).
  [[nodiscard]] int owner(std::size_t tile) const { return owners_[tile]; }
  /// The tiles of a compositor, in scanline order, which is also the order in which every projector sends them.
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
