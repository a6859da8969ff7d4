// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "frame/grid/volume_frames.hpp"
#include "volume/split/image_split.hpp"
#include "volume/split/tile_costs.hpp"

namespace tessera::frame {

/// The times that a rank needed for its part of a frame.
struct CastTimes {
  bool whole = true;          ///< the part was not stopped
  std::uint64_t process = 0;  ///< number that identifies the rank's process on all machines
  double cpu_seconds = 0;     ///< CPU seconds of the process for this frame
  std::vector<volume::TileTime> tiles;
};

/// Rank 0's part of `Balance::learned`: splits a frame by the times that its tiles took in earlier frames, if the view
/// is close to the views of those frames.
///
/// A split gives all processes the same predicted time. The prediction covers the tiles of a process and everything
/// else that it does for a frame, as measured in earlier frames. Rank 0 also gathers the pixels, and so gets fewer
/// tiles. While a view moves, the tiles of a rank take more or less time than predicted, and the deviation is similar
/// from frame to frame; this deviation is learned too.
class SplitByTimes {
 public:
  /// Learns from the times of the frame of `job`; `ranks` has the times of each rank. `box` contains the volume.
  void learn(const VolumeJob& job, const scene::Box& box, const std::vector<CastTimes>& ranks);

  /// Returns the split of a frame, or nothing if too little has been learned.
  [[nodiscard]] std::optional<volume::ImageSplit> find(const VolumeJob& job, const scene::Box& box);

  /// The share of the tiles that each rank should get if find() returns nothing. Empty if nothing has been learned.
  [[nodiscard]] std::vector<double> weights() const;

 private:
  /// Learns `missed_` from the time that the tiles of each rank took, in nanoseconds.
  void compare_with_prediction(const std::vector<double>& tiles_of);

  std::optional<volume::TileCosts> costs_;
  int pictures_ = 0;                ///< number of frames from which it has learned
  double tiles_ = 0;                ///< time of all tiles in the last frame, in nanoseconds
  std::vector<double> other_work_;  ///< time of each rank for other work than its tiles, in nanoseconds
  /// Predicted time of each rank's tiles in the last split, in nanoseconds; empty: none.
  std::vector<double> predicted_;
  std::vector<double> missed_;  ///< how much each rank's share of the time of all tiles exceeds the prediction
};

/// Whether rays pass through the box in nearly the same directions in both views: the viewing directions differ by less
/// than `most` radians, and the eyes are closer together than `most` times the distance of `camera` to the centre of
/// the box.
bool is_near(const scene::Camera& camera, const scene::Camera& other, const scene::Box& box, double most);

}  // namespace tessera::frame
