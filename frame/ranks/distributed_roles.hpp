// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <exception>
#include <optional>

#include "exchange/host_team.hpp"
#include "frame/mesh/boundary_faces.hpp"
#include "frame/mesh/frame_projector.hpp"
#include "frame/ranks/compositing_device.hpp"
#include "frame/ranks/distributed.hpp"

/// The three parts of a distributed run, each a loop on a thread of its own; DistributedRenderer starts those that a
/// rank has. All throw the run's error.
namespace tessera::frame {

struct DistributedRun {
  exchange::Transport& transport;
  const DistributedSettings& settings;
  std::span<const FrameJob> jobs;
  const scene::TransferFunction& function;
  const CompositingDevice& device;              ///< of this rank's compositor
  std::chrono::steady_clock::time_point start;  ///< all ranks were ready
  const std::stop_token& stop;                  ///< asked for on any rank
  std::uint32_t first;                          ///< number of the first job: frames are counted over all lists
};

/// The job of frame `number`. Throws Error(system_failure) if there is none.
const FrameJob& job_of(const DistributedRun& run, std::uint32_t number);

/// A projector's part of the mesh at hand, prepared.
class LoadedMesh {
 public:
  /// `team`: of the projectors of this machine, which share what they load; null: none. Both must outlive this object.
  LoadedMesh(exchange::Transport& transport, const DistributedSettings& settings,
             const std::function<ProjectorMesh(std::size_t)>& mesh_of, exchange::HostTeam* team);
  /// Loads mesh `number` unless that is the one at hand. Collective.
  void load(std::size_t number);
  /// With a team, the parts of all its members.
  [[nodiscard]] const ProjectorMesh& mesh() const { return mesh_; }
  /// With whom this mesh is projected; null: with nobody.
  [[nodiscard]] exchange::HostTeam* team() const { return shared_ ? team_ : nullptr; }
  [[nodiscard]] FrameProjector& projector() { return *projector_; }
  [[nodiscard]] const BoundaryFaces* boundary() const { return boundary_ ? &*boundary_ : nullptr; }

 private:
  void share_mesh();

  exchange::Transport& transport_;
  Settings settings_;
  const std::function<ProjectorMesh(std::size_t)>& mesh_of_;
  exchange::HostTeam* team_;
  std::optional<std::size_t> number_;
  ProjectorMesh mesh_;
  bool shared_ = false;  ///< mesh_ is in the team's memory
  std::optional<FrameProjector> projector_;
  std::optional<BoundaryFaces> boundary_;  ///< if the settings have surfaces of it
};

/// Projects this rank's part of every mesh and sends the fragments.
void run_projector(const DistributedRun& run, LoadedMesh& loaded);

/// Merges the fragments of this rank's tiles and sends finished tiles to the assembling rank.
void run_compositor(const DistributedRun& run);

/// Puts pictures together, tells the projectors, and hands them out, and their tiles before them. What the caller's
/// functions throw is returned once all frames are through, and `stop_all` called at once.
std::exception_ptr run_assembler(const DistributedRun& run, const DistributedCallbacks& callbacks,
                                 const std::function<void()>& stop_all);

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
