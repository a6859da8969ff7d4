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

/// The three parts of a distributed run: projector, compositor and assembler. Each is a loop on its own thread;
/// DistributedRenderer starts those that its rank has. All of them throw the run's error.
namespace tessera::frame {

struct DistributedRun {
  exchange::Transport& transport;
  const DistributedSettings& settings;
  std::span<const FrameJob> jobs;
  const scene::TransferFunction& function;
  const CompositingDevice& device;              ///< the device of this rank's compositor
  std::chrono::steady_clock::time_point start;  ///< when all ranks were ready
  const std::stop_token& stop;                  ///< requested on any rank
  std::uint32_t first;                          ///< number of the first job; numbers continue over all lists of frames
};

/// The job of frame `number`. Throws Error(system_failure) if no job has this number.
const FrameJob& job_of(const DistributedRun& run, std::uint32_t number);

/// A projector's part of the current mesh, prepared for projection.
class LoadedMesh {
 public:
  /// `team` consists of the projectors of this machine, which share the mesh that they load; may be null. `team` and
  /// `mesh_of` must outlive this object.
  LoadedMesh(exchange::Transport& transport, const DistributedSettings& settings,
             const std::function<ProjectorMesh(std::size_t)>& mesh_of, exchange::HostTeam* team);
  /// Loads mesh `number` unless it is the current one. Collective.
  void load(std::size_t number);
  /// The mesh to project. With a team, it consists of the parts of all members.
  [[nodiscard]] const ProjectorMesh& mesh() const { return mesh_; }
  /// The team that projects this mesh; null: this process projects it alone.
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
  bool shared_ = false;  ///< whether `mesh_` is in the team's shared memory
  std::optional<FrameProjector> projector_;
  std::optional<BoundaryFaces> boundary_;  ///< if the settings have boundary surfaces
};

/// Projects this rank's part of every mesh and sends the fragments.
void run_projector(const DistributedRun& run, LoadedMesh& loaded);

/// Merges the fragments of this rank's tiles and sends finished tiles to the assembling rank.
void run_compositor(const DistributedRun& run);

/// Assembles frames, notifies the projectors, and passes tiles and frames to the callbacks. If a callback throws, calls
/// `stop_all` at once and returns the exception after all frames have ended.
std::exception_ptr run_assembler(const DistributedRun& run, const DistributedCallbacks& callbacks,
                                 const std::function<void()>& stop_all);

/// How a rank's memory budget is divided.
struct ExchangeBudget {
  std::uint64_t projection;  ///< for the frame buffers of the rank's projector
  std::uint64_t backlog;     ///< for fragments that wait to be sent
  std::uint64_t window;      ///< for what each projector may send ahead to each compositor
  std::uint64_t tile;        ///< for the fragments of one tile at its compositor
  std::uint64_t cut;         ///< bytes of runs of one tile from one projector after which the runs are cut in depth
};
ExchangeBudget exchange_budget(const DistributedSettings& settings);

}  // namespace tessera::frame
