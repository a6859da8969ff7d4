// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "exchange/tile_map.hpp"
#include "exchange/wire.hpp"
#include "scene/trace.hpp"

namespace tessera::exchange {

/// A projector's side of the exchange: takes parts of tiles from many threads and sends them to the tiles' compositors,
/// in tile order, in messages of about 256 KiB, while projection goes on.
///
/// Flow control. A compositor gives every projector a window of bytes. It gives bytes back once the tile they belong to
/// is its first unfinished one, or finished; so what a projector sends ahead of the others is at most the window, and a
/// slow compositor holds at most N windows and one tile. What cannot be sent waits here, and put() blocks when it is
/// too much.
///
/// No deadlock: order tiles by (frame, tile). Every projector starts its tiles in that order and streams to a
/// compositor in that order, so parts of a compositor's first unfinished tile are always covered by credit; and put()
/// for a projector's own first unfinished tile waits only for that tile's compositor. A cycle of waiting ranks would
/// need a tile that comes before itself.
class Outbox {
 public:
  struct Settings {
    std::vector<int> compositor_ranks;
    std::uint64_t window_bytes;   ///< to each compositor, beyond what it has given back
    std::uint64_t backlog_bytes;  ///< that may wait here before put() blocks
    scene::Trace* trace = nullptr;
    int projector = 0;  ///< which one this is, 0 .. N-1
  };
  Outbox(Transport& transport, Settings settings);
  ~Outbox();
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  /// Starts a frame: tells every compositor which of its tiles will get parts. Parts of each of those follow by put(),
  /// the last one of a tile marked so. `facts`: all but the number of tiles. `map` must live until end_frame().
  void begin_frame(std::uint32_t frame, const TileMap& map, const std::vector<bool>& has_parts,
                   const FrameBegin& facts);

  /// Any thread; parts of one tile in order, from one thread. Blocks while too much waits to be sent; throws the run's
  /// error.
  void put(TilePart part);

  /// No part of tile `tile` will be put, though it was announced: others have it all. In order with the parts of other
  /// tiles of the thread. Does not block.
  void pass(std::uint32_t tile);

  /// Sends what is there of messages that are not full: who waits for other ranks keeps nothing back.
  void flush();

  /// Ends all tiles of the frame that have not been ended, as they are: the frame is stopped.
  void end_tiles();

  /// All parts of the frame have been put: says so to one compositor (end_goes_to()). The traffic that the frame made
  /// here is added to `sums`.
  void end_frame(FrameEnd sums);

 private:
  struct Tile {
    std::deque<TilePart> parts;
    bool ended = false;
  };
  struct Lane {
    int rank;
    std::uint64_t in_flight = 0;      ///< sent and not given back
    Bytes batch;                      ///< message being filled
    std::deque<Bytes> ready;          ///< messages that wait for credit
    std::uint64_t waiting = 0;        ///< bytes in batch and ready
    std::deque<std::uint32_t> order;  ///< the frame's tiles that are not complete here, first one first
  };
  void take_credit();
  void accept(TilePart part);
  [[nodiscard]] Bytes frame_message(MessageKind kind, std::size_t room = 0) const;
  void write(Lane& lane, const TilePart& part);
  void seal(Lane& lane);
  void drain(Lane& lane);
  void advance(Lane& lane);
  [[nodiscard]] bool must_wait(std::uint32_t tile) const;

  Transport& transport_;
  Settings settings_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Lane> lanes_;
  std::map<std::uint32_t, Tile> early_;  ///< tiles that are not first on their lane
  std::uint64_t early_bytes_ = 0;
  int threads_waiting_ = 0;
  std::deque<std::uint32_t> unfinished_;  ///< of the frame, in order
  std::vector<bool> finished_;
  const TileMap* map_ = nullptr;
  std::uint32_t frame_ = 0;
  std::uint64_t fragments_ = 0, bytes_ = 0, messages_ = 0;
  bool closing_ = false;
  std::thread credit_thread_;
};

}  // namespace tessera::exchange
