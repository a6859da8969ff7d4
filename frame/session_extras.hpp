#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "exchange/transport.hpp"
#include "frame/compositing_device.hpp"
#include "scene/trace.hpp"
#include "tessera/session.hpp"
#include "volume/cost_map.hpp"
#include "volume/image_split.hpp"

/// What the program asks of sessions beside what every caller may.
namespace tessera::frame {

struct SessionExtras {
  /// Faces of this rank's trace; null: no timing. One process uses `projecting` alone.
  scene::Trace *projecting = nullptr, *compositing = nullptr;
  /// On a device a mesh goes through the exchange on one rank too.
  CompositingSettings compositing_on;
  std::uint32_t first_frame = 0;  ///< meshes on ranks: number of the first frame in traces
  bool bounded = true;            ///< false: composited on a device whose error is only reported
  bool keep_cost = false;         ///< grids: rank 0 finds the cost of the whole picture, see balance_of()
};

/// A session by the ranks of a transport, which it shares with others.
Session make_session(Dataset dataset, const Settings& settings, exchange::Transport& transport,
                     const SessionExtras& extras);

/// Dataset::open, with its time in `trace`; the data set of a mesh in parts goes to `roles`.
Dataset open_dataset(std::span<const std::filesystem::path> files, const ReadOptions& options,
                     exchange::Transport& transport, const RankSettings& ranks, scene::Trace* trace);

/// Of a grid's last frame, on rank 0: how the picture was split, and what it was thought to cost.
struct GridBalance {
  volume::ImageSplit split;
  volume::CostMap cost;
  std::vector<std::array<glm::dvec3, 2>> bricks;  ///< that the transfer function shows, corners in index space
};
GridBalance balance_of(const Session& session, const TransferFunction& function);

}  // namespace tessera::frame
