// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "exchange/tile_map.hpp"
#include "exchange/wire.hpp"

namespace tessera::exchange {

/// Records which parts of one frame a compositor has received, and which are still missing. Does not start threads or
/// send messages.
class FrameCollector {
 public:
  /// Collects from `projectors` projectors, numbered 0 .. N-1, the tiles of `compositor` in `map`. The map must outlive
  /// this object.
  FrameCollector(int projectors, const TileMap& map, int compositor);

  void begin(int projector, const FrameBegin& begin, std::span<const std::byte> bits);
  void end(const FrameEnd& sums);
  /// Adds a part. Returns the depth from which on the part adds to the tile: the depth to which the projector's
  /// previous part was complete.
  double add(int projector, TilePart part);

  [[nodiscard]] bool has_all_begins() const { return begins_ == projectors_; }
  /// Whether all projectors that send their ends to this compositor have done so.
  [[nodiscard]] bool has_all_ends() const { return ends_ == ends_awaited_; }
  [[nodiscard]] double longest_ray() const { return longest_ray_; }
  [[nodiscard]] float longest_edge() const { return longest_edge_; }
  [[nodiscard]] const FrameEnd& sums() const { return sums_; }

  /// Parts of a tile that wait to be merged.
  struct Waiting {
    std::vector<TilePart> parts;  ///< ascending by `start_depth`: a part may be merged once all segments in front of
                                  ///< its `start_depth` have been merged
    double final_depth;           ///< the tile is complete up to this planar depth; infinity: complete
    bool all;                     ///< whether no more parts will come
  };
  /// Whether a tile can be merged: it is complete and not merged yet, or enough of it can be merged to free memory.
  [[nodiscard]] bool has_work(std::uint32_t tile) const;
  Waiting take(std::uint32_t tile);

  /// Marks a tile as composited.
  void finish(std::uint32_t tile);
  [[nodiscard]] bool finished() const;  ///< whether all tiles are composited and all ends have arrived

  /// Records that the bytes of a part must be returned to its projector. The bytes are due once all tiles up to the
  /// part's tile are composited. They are due earlier if all tiles before the part's tile are composited, and the part
  /// does not begin behind the depth to which all projectors have completed its tile. pay() returns the number of bytes
  /// that are due.
  void owe(int projector, std::uint32_t tile, double start_depth, std::uint64_t bytes);
  std::uint64_t pay(int projector);

 private:
  struct Tile {
    int contributors = 0, ended = 0;
    /// One per projector: initially -infinity; +infinity for projectors without parts.
    std::vector<double> final_depth;
    std::vector<TilePart> parts;
    std::uint64_t bytes = 0;
    double merged_to = -std::numeric_limits<double>::infinity();
    bool composited = false;
  };
  Tile& tile(std::uint32_t number);
  [[nodiscard]] const Tile& tile(std::uint32_t number) const;
  [[nodiscard]] double final_depth(const Tile& tile) const;
  [[nodiscard]] bool is_complete(const Tile& tile) const { return has_all_begins() && tile.ended == tile.contributors; }
  void advance();

  int projectors_;
  const std::vector<std::uint32_t>* numbers_;  ///< numbers of this compositor's tiles, in order
  std::vector<Tile> tiles_;                    ///< one per element of `numbers_`
  std::size_t first_unfinished_ = 0;
  int begins_ = 0, ends_ = 0, ends_awaited_ = 0;
  double longest_ray_ = 0;
  float longest_edge_ = 0;
  FrameEnd sums_{};
  struct Debt {
    std::uint32_t tile;
    double start_depth;
    std::uint64_t bytes;
  };
  [[nodiscard]] bool is_ahead(const Debt& debt) const;
  std::vector<std::vector<Debt>> debts_;  ///< one list per projector
};

}  // namespace tessera::exchange
