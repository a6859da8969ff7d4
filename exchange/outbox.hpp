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

/// A projector's side of the exchange. Many threads pass parts of tiles to the outbox, which sends them to the
/// compositors of the tiles, in tile order, in messages of about 256 KiB, while projection continues.
///
/// Flow control. A compositor grants every projector a window of bytes. It returns the bytes of a part once the part's
/// tile is finished or is the compositor's first unfinished tile. So a projector is ahead of the others by at most its
/// window, and a slow compositor stores at most the windows of N projectors and one tile. Bytes that cannot be sent
/// wait in the outbox, and put() blocks when they exceed the backlog.
///
/// No deadlock. Order all tiles by (frame, tile). Every projector starts its tiles and streams to a compositor in this
/// order, so the parts of a compositor's first unfinished tile are always covered by credit. And put() for a
/// projector's own first unfinished tile waits only for the compositor of that tile. A cycle of waiting ranks would
/// therefore need a tile that precedes itself.
class Outbox {
 public:
  struct Settings {
    std::vector<int> compositor_ranks;
    std::uint64_t window_bytes;   ///< bytes that may be sent to each compositor beyond those that it has returned
    std::uint64_t backlog_bytes;  ///< bytes that may wait here before put() blocks
    scene::Trace* trace = nullptr;
    int projector = 0;  ///< the number of this projector, 0 .. N-1
  };
  Outbox(Transport& transport, Settings settings);
  ~Outbox();
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  /// Starts a frame: informs every compositor which of its tiles will get parts. For each of these tiles, calls of
  /// put() must follow, with the last part marked as last. This function fills in the number of tiles in `facts`. `map`
  /// must live until end_frame().
  void begin_frame(std::uint32_t frame, const TileMap& map, const std::vector<bool>& has_parts,
                   const FrameBegin& facts);

  /// Sends a part of a tile. May be called by any thread; the parts of one tile must come in order, from one thread.
  /// Blocks while the backlog is too large. Throws the run's error.
  void put(TilePart part);

  /// Ends tile `tile`, which was announced, without a part, because other projectors have all of it. Each thread must
  /// call put() and pass() in tile order. Does not block.
  void pass(std::uint32_t tile);

  /// Sends messages that are not full yet. A thread must call this before it waits for other ranks, so that no data are
  /// held back.
  void flush();

  /// Ends all unfinished tiles of the frame, although they are incomplete, because the frame is stopped.
  void end_tiles();

  /// Ends the frame after all of its parts have been put. Sends its end to one compositor (end_goes_to()); the end
  /// contains `sums` plus the traffic of this projector in the frame.
  void end_frame(FrameEnd sums);

 private:
  struct Tile {
    std::deque<TilePart> parts;
    bool ended = false;
  };
  struct Lane {
    int rank;
    std::uint64_t in_flight = 0;      ///< bytes that were sent and have not been returned
    Bytes batch;                      ///< the message that is being filled
    std::deque<Bytes> ready;          ///< messages that wait for credit
    std::uint64_t waiting = 0;        ///< bytes in `batch` and `ready`
    std::deque<std::uint32_t> order;  ///< the frame's tiles whose parts have not all been passed to this lane, in order
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
  std::map<std::uint32_t, Tile> early_;  ///< tiles that are not yet first on their lane
  std::uint64_t early_bytes_ = 0;
  int threads_waiting_ = 0;
  std::deque<std::uint32_t> unfinished_;  ///< unfinished tiles of the frame, in order
  std::vector<bool> finished_;
  const TileMap* map_ = nullptr;
  std::uint32_t frame_ = 0;
  std::uint64_t fragments_ = 0, bytes_ = 0, messages_ = 0;
  bool closing_ = false;
  std::thread credit_thread_;
};

}  // namespace tessera::exchange
