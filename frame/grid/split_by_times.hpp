// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "frame/grid/volume_frames.hpp"
#include "volume/split/image_split.hpp"
#include "volume/split/tile_costs.hpp"

namespace tessera::frame {

/// The times of a rank's part of a frame.
struct CastTimes {
  bool whole = true;          ///< it was not stopped
  std::uint64_t process = 0;  ///< of the rank
  double cpu_seconds = 0;     ///< of the process, for the frame
  std::vector<volume::TileTime> tiles;
};

/// Rank 0's part of `Balance::learned`: splits a frame by the times of the tiles in earlier frames, if its view is near
/// theirs.
///
/// A split gives each process the same time, for its tiles and for everything else that it does for a frame, as in
/// earlier frames. Rank 0 also gathers, and so gets fewer tiles. While a view moves, the tiles of a rank take more or
/// less time than predicted, in a similar way from frame to frame; this deviation is learned too.
class SplitByTimes {
 public:
  /// Learns from the times of the frame of `job`, by rank; `box` contains the volume.
  void learn(const VolumeJob& job, const scene::Box& box, const std::vector<CastTimes>& ranks);

  /// The split of a frame; none if too little is known.
  [[nodiscard]] std::optional<volume::ImageSplit> find(const VolumeJob& job, const scene::Box& box);

  /// The share of the tiles that each rank should get if find() returns none. Empty if nothing is known.
  [[nodiscard]] std::vector<double> weights() const;

 private:
  /// Learns `missed_` from the time of each rank's tiles, nanoseconds.
  void compare_with_prediction(const std::vector<double>& tiles_of);

  std::optional<volume::TileCosts> costs_;
  int pictures_ = 0;                ///< frames learned from
  double tiles_ = 0;                ///< nanoseconds of the last frame
  std::vector<double> other_work_;  ///< nanoseconds of each rank, excluding its tiles
  std::vector<double> predicted_;   ///< predicted nanoseconds of each rank's tiles in the last split; empty: none
  std::vector<double> missed_;      ///< how much each rank's share of the time of all tiles exceeds the prediction
};

/// Whether rays go through the box in nearly the same directions as in another view of it: within `most` radians, and
/// `most` of the distance to its centre.
bool is_near(const scene::Camera& camera, const scene::Camera& other, const scene::Box& box, double most);

}  // namespace tessera::frame
