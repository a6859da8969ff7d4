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

/// The last step (Juliachs et al. 2007, section 3): compositors send their tiles to the first compositor, which
/// assembles the image. exchange/message.hpp describes their messages, on channel `tiles`.
namespace tessera::compositor {

/// Sends a compositor's finished tiles of one frame, in messages of about 128 KiB. May be used by any thread; each
/// thread packs its own tiles. Tiles that this rank sends to itself are not packed.
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

/// An assembled image.
struct AssembledFrame {
  std::uint32_t frame;
  scene::Image image;
  exchange::FrameEnd sums;
  scene::DeepImage deep;  ///< if requested
};

/// Settings of the assembly. Unset functions are not called.
struct AssemblySettings {
  std::function<projection::TileGrid(std::uint32_t frame)> grid_of;  ///< returns the tile grid of a frame
  std::uint64_t deep_bytes = 0;  ///< largest size of a deep image's samples, in bytes; 0: no deep image
  /// Runs a task, on another thread or immediately. Many tasks may run at once.
  std::function<void(std::function<void()> work)> run;
  /// Called for each tile of a frame when its pixels are final, on the thread that placed them. For empty tiles it is
  /// called by accept(), at the end of the frame, unless the frame was stopped.
  std::function<void(std::uint32_t frame, const scene::PixelRect& rect, const scene::Image& image)> finished;
  /// Returns an image whose memory the frame may use; its contents are ignored. The image is not used if its size
  /// differs.
  std::function<scene::Image(scene::ImageSize size)> memory;
  scene::Trace* trace = nullptr;
};

/// Assembles images on the first compositor. Frames complete in order.
///
/// One thread passes the messages to accept(); the tiles of each message are one task for AssemblySettings::run. Tiles
/// are disjoint, so tasks never write the same pixels. Only the pixels of tiles that do not arrive are cleared.
class ImageAssembly {
 public:
  ImageAssembly(int compositors, AssemblySettings settings);
  /// Waits until the tasks that have begun are finished.
  ~ImageAssembly();
  ImageAssembly(const ImageAssembly&) = delete;
  ImageAssembly& operator=(const ImageAssembly&) = delete;

  /// Takes a message of channel `tiles`. If the message completes a frame, waits for the frame's last tiles and returns
  /// the frame. Throws Error(system_failure) if the message does not have the format of exchange/message.hpp. Errors in
  /// tiles are thrown by the task of the tiles, and by accept() when the frame would be complete.
  std::optional<AssembledFrame> accept(exchange::Message message);

 private:
  struct Frame {
    explicit Frame(const projection::TileGrid& of) : grid(of), has_come(of.count()) {}
    projection::TileGrid grid;
    scene::Image image;
    exchange::FrameEnd sums{};
    int ended = 0, working = 0;  ///< `working` is guarded by mutex_
    std::unique_ptr<DeepCollector> deep;
    std::vector<std::atomic<bool>> has_come;  ///< one flag per tile
    std::vector<scene::PixelRect> lacking;    ///< set at the end: the tiles that have not arrived
  };

  Frame& frame_of(std::uint32_t number);
  void start(Frame& frame, std::function<void()> work);
  void place(Frame& frame, std::uint32_t number, const exchange::Message& message);
  void wait_for(const Frame& frame);
  void fill_what_lacks(Frame& frame, std::uint32_t number);

  int compositors_;
  AssemblySettings settings_;
  std::map<std::uint32_t, Frame> frames_;
  std::mutex mutex_;  // guards `working` and the members below
  std::condition_variable changed_;
  std::exception_ptr fault_;  ///< error of the first task that failed
};

}  // namespace tessera::compositor
