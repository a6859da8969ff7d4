// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "frame/grid/volume_frames.hpp"
#include "volume/split/image_split.hpp"
#include "volume/split/tile_costs.hpp"

namespace tessera::frame {

/// What a rank says of its part of a picture.
struct CastTimes {
  bool whole = true;          ///< it was not stopped
  std::uint64_t process = 0;  ///< that the rank is in
  double cpu_seconds = 0;     ///< of the process, for the picture
  std::vector<volume::TileTime> tiles;
};

/// Rank 0's share in `Balance::learned`: the split of a picture by what each tile of the pictures before took, where
/// the view is near theirs.
///
/// A split gives each process the same time: of its tiles and of all else that it does for a picture, as it was in the
/// pictures before. Rank 0 gathers as well, and so gets less of the tiles. While a view moves, tiles of a rank take now
/// more, now less than is foreseen, from picture to picture alike: that is learned too.
class SplitByTimes {
 public:
  /// What the picture of `job` took, by rank; `box` holds the volume.
  void learn(const VolumeJob& job, const scene::Box& box, const std::vector<CastTimes>& ranks);

  /// Of a picture; nothing if too little is known.
  [[nodiscard]] std::optional<volume::ImageSplit> find(const VolumeJob& job, const scene::Box& box);

  /// How much of the tiles each rank should get of a split that this one does not find. Empty if nothing is known.
  [[nodiscard]] std::vector<double> weights() const;

 private:
  /// Learns `missed_` from the time of each rank's tiles, nanoseconds.
  void compare_with_foreseen(const std::vector<double>& tiles_of);

  std::optional<volume::TileCosts> costs_;
  int pictures_ = 0;              ///< that it has learned from
  double tiles_ = 0;              ///< nanoseconds of the last picture
  std::vector<double> beside_;    ///< nanoseconds of each rank, beside its tiles
  std::vector<double> foreseen_;  ///< nanoseconds of each rank's tiles, in the split last found; empty: none was
  std::vector<double> missed_;    ///< by how much each rank's share of all tiles' time is larger than foreseen
};

/// Whether rays go through the box about as they do in another view of it: within `most` radians, and `most` of the
/// distance to its middle.
bool is_near(const scene::Camera& camera, const scene::Camera& other, const scene::Box& box, double most);

}  // namespace tessera::frame
