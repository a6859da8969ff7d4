#pragma once

#include "frame/distributed.hpp"

/// The three parts of a distributed run, each a loop on a thread of its own; render_distributed() starts those that a
/// rank has. All throw the run's error.
namespace tessera::frame {

struct DistributedRun {
  compositor::Transport& transport;
  const DistributedSettings& settings;
  std::span<const FrameJob> jobs;
  const scene::TransferFunction& function;
};

/// Projects this rank's part of every mesh and sends the fragments.
void run_projector(const DistributedRun& run, const std::function<ProjectorMesh(std::size_t)>& mesh_of);

/// Merges the fragments of this rank's tiles and sends finished tiles to the assembling rank.
void run_compositor(const DistributedRun& run);

/// Puts pictures together, tells the projectors, and hands them out.
void run_assembler(const DistributedRun& run, const std::function<void(FinishedFrame)>& done);

/// How a rank's memory budget is shared out.
struct ExchangeBudget {
  std::uint64_t projection;  ///< frame buffers of its projector
  std::uint64_t backlog;     ///< fragments that wait to be sent
  std::uint64_t window;      ///< that each projector may send ahead to each compositor
  std::uint64_t tile;        ///< fragments of one tile at its compositor
  std::uint64_t cut;         ///< bytes of runs of one tile and projector after which they are cut in depth
};
ExchangeBudget exchange_budget(const DistributedSettings& settings);

}  // namespace tessera::frame
