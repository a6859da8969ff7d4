#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "compositor/deep_collector.hpp"
#include "compositor/tile_merger.hpp"
#include "exchange/wire.hpp"
#include "projection/tile_lists.hpp"
#include "scene/image.hpp"

/// The last and only sequential step (Juliachs et al. 2007, section 3): compositors send their tiles to the first one,
/// which puts the picture together. Their messages, on channel `tiles`, are in exchange/message.hpp.
namespace tessera::compositor {

/// A compositor's finished tiles of one frame on their way, in messages of about half a megabyte. Any thread.
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

/// Puts pictures together on the first compositor. Frames complete in order.
class ImageAssembly {
 public:
  /// Hears of each tile of a frame when its pixels are final; of those in which nothing is, at the frame's end.
  using Finished = std::function<void(std::uint32_t frame, const scene::PixelRect& rect, const scene::Image& image)>;

  /// `grid_of(frame)`: the frame's tiles. `deep_bytes`: bound of a deep picture's samples; 0: no deep pictures.
  ImageAssembly(int compositors, std::function<projection::TileGrid(std::uint32_t)> grid_of,
                std::uint64_t deep_bytes = 0, Finished finished = {});

  /// Takes a message of channel `tiles`; the frame that it completes, if any. Throws Error(system_failure) if it is not
  /// what message.hpp says.
  std::optional<AssembledFrame> accept(const exchange::Message& message);

 private:
  struct Frame {
    scene::Image image;
    projection::TileGrid grid;
    exchange::FrameEnd sums{};
    int ended = 0;
    std::unique_ptr<DeepCollector> deep;
    std::vector<bool> has_come;  ///< by tile, if somebody wants to hear of them
  };
  int compositors_;
  std::function<projection::TileGrid(std::uint32_t)> grid_of_;
  std::uint64_t deep_bytes_;
  Finished finished_;
  std::map<std::uint32_t, Frame> frames_;
};

}  // namespace tessera::compositor
