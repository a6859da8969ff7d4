// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/distributed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "exchange/collectives.hpp"
#include "frame/mesh/peel.hpp"
#include "frame/ranks/distributed_roles.hpp"
#include "frame/ranks/host_mesh.hpp"
#include "frame/ranks/run_error.hpp"
#include "frame/ranks/stop_relay.hpp"
#include "scene/error.hpp"
#include "scene/error_budget.hpp"
#include "scene/start_thread.hpp"
#include "scene/threads.hpp"

namespace tessera::frame {

ExchangeBudget exchange_budget(const DistributedSettings& settings) {
  const std::uint64_t memory = settings.render.memory_bytes;
  const auto projectors = static_cast<std::uint64_t>(settings.roles.projectors.size());
  constexpr std::uint64_t most_ahead = 8 << 20, least_ahead = 256 << 10;
  constexpr std::uint64_t most_between_cuts = 4 << 20, least_between_cuts = 64 << 10;
  // Half of the memory is for the projector; the rest is for a compositor's windows and the tiles that its threads
  // merge.
  return {memory / 2, std::min<std::uint64_t>(memory / 16, 64 << 20),
          std::clamp(memory / 8 / projectors, least_ahead, most_ahead), memory / 4,
          std::clamp(memory / 16 / projectors, least_between_cuts, most_between_cuts)};
}

LoadedMesh::LoadedMesh(exchange::Transport& transport, const DistributedSettings& settings,
                       const std::function<ProjectorMesh(std::size_t)>& mesh_of, exchange::HostTeam* team)
    : transport_(transport), settings_(settings.render), mesh_of_(mesh_of), team_(team) {
  settings_.memory_bytes = exchange_budget(settings).projection;
  settings_.trace = settings.projecting;
}

void LoadedMesh::load(std::size_t number) {
  if (number_ == number) return;
  projector_.reset();  // free the last mesh's memory before loading the next one
  mesh_ = {};
  boundary_.reset();
  mesh_ = mesh_of_(number);
  if (team_ != nullptr) share_mesh();
  if (!settings_.surfaces.boundary.empty())
    boundary_ = boundary_faces(mesh_.part, transport_, team() != nullptr ? team()->ranks().front() : transport_.rank());
  if (mesh_.prepared != nullptr)
    projector_.emplace(mesh_.prepared,
                       scene::with_threads(settings_.threads, [&] { return scene::bounds(mesh_.part); }), settings_);
  else
    projector_.emplace(mesh_.part, settings_);
  number_ = number;
}

void LoadedMesh::share_mesh() {
  team_->begin();
  if (mesh_.prepared == nullptr) mesh_.prepared = std::make_shared<const projection::PreparedMesh>(mesh_.part);
  const HostMesh host = HostMesh::made(*team_, mesh_.part, mesh_.prepared->tets(), mesh_.global_tet);
  shared_ = !host.mesh.tets.empty();
  if (!shared_) return;
  mesh_.part = host.mesh;
  mesh_.global_tet = host.global_tet;
  mesh_.prepared.reset();
  mesh_.owner.reset();
}

const FrameJob& job_of(const DistributedRun& run, std::uint32_t number) {
  if (number - run.first >= run.jobs.size())
    throw scene::Error(
        scene::ErrorCode::system_failure,
        fmt::format(
            "exchange: frame {} is not one of the {} frames from {} on; all ranks must be given the same arguments",
            number, run.jobs.size(), run.first));
  return run.jobs[number - run.first];
}

namespace {

void check(const DistributedSettings& settings) {
  if (settings.render.mesh.rasterizer == Rasterizer::scanline && settings.exchange == Exchange::runs)
    throw scene::bad_input("`exchange` runs: segments of `rasterizer` scanline do not touch; use `exchange` segments");
  if (settings.frame.by_depth() && settings.exchange == Exchange::runs)
    throw scene::bad_input(
        fmt::format("`exchange` runs: {} needs single ray segments, which runs combine; use `exchange` segments",
                    settings.frame.peel ? "`peel`" : "a deep image"));
  const scene::Integrator& integrator = settings.render.integrator;
  if (settings.exchange == Exchange::runs && integrator.kind == scene::IntegratorKind::automatic &&
      !scene::error_budget::runs_keep(integrator.accuracy, settings.render.mesh.shading.has_value()))
    throw scene::bad_input(fmt::format(
        "`exchange` runs: `accuracy` {} is too strict for runs, whose error may be {}; use `exchange` segments",
        integrator.accuracy, scene::error_budget::runs));
  const DeviceSettings& device = settings.render.mesh.device;
  const bool on_device = std::ranges::any_of(device.backends, [](Backend b) { return b != Backend::cpu; });
  if (on_device && !settings.render.surfaces.empty())
    throw scene::bad_input(fmt::format("{}: surfaces are composited on the CPU; leave out `compositor` and `backend`",
                                       surface_word(settings.render.surfaces)));
  if (on_device && settings.render.mesh.shading)
    throw scene::bad_input("`shade`: meshes are shaded on the CPU; leave out `compositor` and `backend`");
  if (on_device && settings.frame.by_depth())
    throw scene::bad_input(fmt::format("{}: it is composited on the CPU; leave out `compositor` and `backend`",
                                       deep_word(settings.frame.peel.has_value())));
  if (on_device && device.method == GlMethod::fragment && settings.exchange == Exchange::runs)
    throw scene::bad_input("`exchange` runs: `compositor` gl-fragment takes ray segments; use `exchange` segments");
  if (on_device && device.method == GlMethod::fragment &&
      (settings.render.integrator.kind == scene::IntegratorKind::preintegrated ||
       settings.render.integrator.kind == scene::IntegratorKind::partial))
    throw scene::bad_input(
        "`integrator`: `compositor` gl-fragment supports sampled:N, exact and auto; use one of these");
}

}  // namespace

class DistributedRenderer::State {
 public:
  State(exchange::Transport& transport, DistributedSettings settings, MeshOf mesh_of)
      : transport_(transport), settings_(std::move(settings)), mesh_of_(std::move(mesh_of)), relay_(transport) {
    check(settings_);
  }

  void set_frame(const FrameSettings& frame, Exchange exchange) {
    DistributedSettings settings = settings_;
    settings.frame = frame;
    settings.exchange = exchange;
    check(settings);
    settings_ = std::move(settings);
  }

  void render(std::span<const FrameJob> jobs, const scene::TransferFunction& function,
              const DistributedCallbacks& callbacks, const std::stop_token& asked) {
    StopRelay::Run relayed(relay_, asked);
    const std::stop_token stop = relayed.token();
    if (!opened_) {
      const bool projects = settings_.roles.projects(transport_.rank());
      if (settings_.render.use.sharing && settings_.roles.projectors.size() > 1)
        team_ = exchange::HostTeam::form(transport_, projects);
      if (projects) loaded_.emplace(transport_, settings_, mesh_of_, team_.get());
    }
    if (!jobs.empty()) load(jobs.front().mesh);
    if (!opened_) {
      open_compositing_device(settings_, transport_, device_);
      opened_ = true;
    }
    exchange::barrier(transport_);  // a frame's time does not include reading
    const DistributedRun run{transport_, settings_,
                             jobs,       function,
                             device_,    std::chrono::steady_clock::now(),
                             stop,       transport_.number_frames(jobs.size())};
    std::exception_ptr of_caller;
    std::vector<std::function<void()>> parts;
    if (loaded_)
      parts.emplace_back([&] { run_projector(run, *loaded_); });
    else
      parts.emplace_back([&] {
        for (const FrameJob& job : jobs) load(job.mesh);
      });
    if (settings_.roles.composites(transport_.rank())) parts.emplace_back([&] { run_compositor(run); });
    if (settings_.roles.assembler() == transport_.rank())
      parts.emplace_back([&] { of_caller = run_assembler(run, callbacks, [&] { relayed.stop(); }); });

    // An error of any part is the run's error: it wakes the other parts.
    const auto guarded = [&](const std::function<void()>& part) {
      try {
        part();
      } catch (const std::exception& fault) {
        transport_.fail(run_error(transport_, fault));
      }
    };
    std::vector<std::thread> threads;
    guarded([&] {
      for (std::size_t i = 1; i < parts.size(); ++i)
        threads.push_back(scene::start_thread([&, i] { guarded(parts[i]); }));
      parts.front()();  // projection, if this rank projects, runs on the calling thread
    });
    for (auto& thread : threads) thread.join();
    transport_.check();
    if (of_caller) std::rethrow_exception(of_caller);
  }

 private:
  /// All ranks load meshes together, including those that do not project.
  void load(std::size_t number) {
    if (loaded_) {
      loaded_->load(number);
    } else if (number_ != number) {
      static_cast<void>(mesh_of_(number));
      if (!settings_.render.surfaces.boundary.empty())
        static_cast<void>(boundary_faces({}, transport_, transport_.rank()));
    }
    number_ = number;
  }

  exchange::Transport& transport_;
  DistributedSettings settings_;
  const MeshOf mesh_of_;
  StopRelay relay_;
  std::unique_ptr<exchange::HostTeam> team_;  ///< only for a projector that shares its machine with other projectors
  std::optional<LoadedMesh> loaded_;          ///< only for a projector
  std::optional<std::size_t> number_;         ///< number of the last mesh that was loaded
  CompositingDevice device_;
  bool opened_ = false;
};

DistributedRenderer::DistributedRenderer(exchange::Transport& transport, DistributedSettings settings, MeshOf mesh_of)
    : state_(std::make_unique<State>(transport, std::move(settings), std::move(mesh_of))) {}
DistributedRenderer::~DistributedRenderer() = default;

void DistributedRenderer::set_frame(const FrameSettings& frame, Exchange exchange) {
  state_->set_frame(frame, exchange);
}

void DistributedRenderer::render(std::span<const FrameJob> jobs, const scene::TransferFunction& function,
                                 const DistributedCallbacks& callbacks, const std::stop_token& stop) {
  state_->render(jobs, function, callbacks, stop);
}

void render_distributed(exchange::Transport& transport, const DistributedSettings& settings,
                        std::span<const FrameJob> jobs, const scene::TransferFunction& function,
                        const std::function<ProjectorMesh(std::size_t)>& mesh_of,
                        const std::function<void(FinishedFrame)>& done) {
  DistributedRenderer(transport, settings, mesh_of).render(jobs, function, {done, {}, {}});
}

}  // namespace tessera::frame
