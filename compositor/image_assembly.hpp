// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "compositor/deep/deep_collector.hpp"
#include "compositor/tile_merger.hpp"
#include "exchange/wire.hpp"
#include "projection/tile_lists.hpp"
#include "scene/image.hpp"
#include "scene/trace.hpp"

/// The last step (Juliachs et al. 2007, section 3): compositors send their tiles to the first one, which puts the
/// picture together. Their messages, on channel `tiles`, are in exchange/message.hpp.
namespace tessera::compositor {

/// A compositor's finished tiles of one frame on their way, in messages of about 128 KiB. Any thread; each packs its
/// tiles itself. A compositor's tiles for its own rank are not packed.
class TileSender {
 public:
  TileSender(exchange::Transport& transport, int assembler, std::uint32_t frame);
  void send(std::uint32_t tile, const MergedTile& merged);
  void end(const exchange::FrameEnd& sums);

 private:
  void flush();

  exchange::Transport& transport_;
  int assembler_;
  std::uint32_t frame_;
  std::mutex mutex_;
  exchange::Bytes message_;
};

/// A picture that has all its tiles.
struct AssembledFrame {
  std::uint32_t frame;
  scene::Image image;
  exchange::FrameEnd sums;
  scene::DeepImage deep;  ///< if asked for
};

/// How pictures are put together. What is not set is not wanted.
struct AssemblySettings {
  std::function<projection::TileGrid(std::uint32_t frame)> grid_of;  ///< a frame's tiles
  std::uint64_t deep_bytes = 0;                                      ///< bound of a deep picture's samples; 0: none
  /// Runs a piece of work, on another thread or at once. Many may run at once.
  std::function<void(std::function<void()> work)> run;
  /// Hears of each tile of a frame when its pixels are final, from the thread that placed them; of those in which
  /// nothing is at the frame's end, from accept().
  std::function<void(std::uint32_t frame, const scene::PixelRect& rect, const scene::Image& image)> finished;
  /// An image whose memory a frame may have, whatever is in it; of another size than asked for: none.
  std::function<scene::Image(scene::ImageSize size)> memory;
  scene::Trace* trace = nullptr;
};

/// Puts pictures together on the first compositor. Frames complete in order.
///
/// One thread gives it messages; each message's tiles are one piece of work for AssemblySettings::run. Tiles are
/// disjoint, so pieces meet nowhere. Only tiles that do not come are cleared.
class ImageAssembly {
 public:
  ImageAssembly(int compositors, AssemblySettings settings);
  /// Waits for the work that has begun.
  ~ImageAssembly();
  ImageAssembly(const ImageAssembly&) = delete;
  ImageAssembly& operator=(const ImageAssembly&) = delete;

  /// Takes a message of channel `tiles`; the frame that it completes, if any: waits for its last tiles. Throws
  /// Error(system_failure) if it is not what exchange/message.hpp says; of tiles the work throws it, and accept() once
  /// more when their frame would be complete.
  std::optional<AssembledFrame> accept(exchange::Message message);

 private:
  struct Frame {
    explicit Frame(const projection::TileGrid& of) : grid(of), has_come(of.count()) {}
    projection::TileGrid grid;
    scene::Image image;
    exchange::FrameEnd sums{};
    int ended = 0, working = 0;  ///< working: guarded by mutex_
    std::unique_ptr<DeepCollector> deep;
    std::vector<std::atomic<bool>> has_come;  ///< by tile
    std::vector<scene::PixelRect> lacking;    ///< at the end: tiles that have not
  };

  Frame& frame_of(std::uint32_t number);
  void start(Frame& frame, std::function<void()> work);
  void place(Frame& frame, std::uint32_t number, const exchange::Message& message);
  void wait_for(const Frame& frame);
  void fill_what_lacks(Frame& frame, std::uint32_t number);

  int compositors_;
  AssemblySettings settings_;
  std::map<std::uint32_t, Frame> frames_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::exception_ptr fault_;  ///< of the first work that failed
};

}  // namespace tessera::compositor
