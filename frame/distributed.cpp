#include "frame/distributed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <thread>
#include <vector>

#include "frame/distributed_roles.hpp"
#include "frame/run_error.hpp"
#include "scene/error.hpp"
#include "scene/start_thread.hpp"

namespace tessera::frame {

ExchangeBudget exchange_budget(const DistributedSettings& settings) {
  const std::uint64_t memory = settings.render.memory_bytes;
  const auto projectors = static_cast<std::uint64_t>(settings.roles.projectors.size());
  constexpr std::uint64_t most_ahead = 8 << 20, least_ahead = 256 << 10;
  constexpr std::uint64_t most_between_cuts = 4 << 20, least_between_cuts = 64 << 10;
  // Half for the projector, the rest for a compositor's windows and the tiles that its threads merge.
  return {memory / 2, std::min<std::uint64_t>(memory / 16, 64 << 20),
          std::clamp(memory / 8 / projectors, least_ahead, most_ahead), memory / 4,
          std::clamp(memory / 16 / projectors, least_between_cuts, most_between_cuts)};
}

LoadedMesh::LoadedMesh(const DistributedSettings& settings, const std::function<ProjectorMesh(std::size_t)>& mesh_of)
    : settings_(settings.render), mesh_of_(mesh_of) {
  settings_.memory_bytes = exchange_budget(settings).projection;
  settings_.trace = settings.projecting;
}

void LoadedMesh::load(std::size_t number) {
  if (number_ == number) return;
  projector_.reset();  // the last mesh's memory before the next one's
  mesh_ = {};
  mesh_ = mesh_of_(number);
  projector_.emplace(*mesh_.part, settings_);
  number_ = number;
}

namespace {

/// Meshes are loaded by all ranks together, those that do not project included.
void take_part_in_loading(const DistributedRun& run, const std::function<ProjectorMesh(std::size_t)>& mesh_of) {
  for (std::size_t frame = 1; frame < run.jobs.size(); ++frame)
    if (run.jobs[frame].mesh != run.jobs[frame - 1].mesh) static_cast<void>(mesh_of(run.jobs[frame].mesh));
}

}  // namespace

void render_distributed(exchange::Transport& transport, const DistributedSettings& settings,
                        std::span<const FrameJob> jobs, const scene::TransferFunction& function,
                        const std::function<ProjectorMesh(std::size_t)>& mesh_of,
                        const std::function<void(FinishedFrame)>& done) {
  if (settings.frames_in_flight < 1)
    throw scene::bad_input(fmt::format("`frames_in_flight` {}: it must be at least 1", settings.frames_in_flight));
  if (settings.render.rasterizer == Rasterizer::scanline && settings.exchange == Exchange::runs)
    throw scene::bad_input("`exchange` runs: segments of `rasterizer` scanline do not touch; use `exchange` segments");
  if (settings.deep && settings.exchange == Exchange::runs)
    throw scene::bad_input("`exchange` runs: a deep picture needs the segments that runs are made of; use segments");
  if (settings.deep) check_deep(settings.render, function);
  const auto& backends = settings.compositing_on.backends;
  const bool on_device = std::any_of(backends.begin(), backends.end(), [](Backend b) { return b != Backend::cpu; });
  if (on_device && settings.deep)
    throw scene::bad_input("deep picture: it is made on the CPU; leave out `compositor` and `backend`");
  if (on_device && settings.compositing_on.gl.method == compositor::GlMethod::fragment &&
      settings.exchange == Exchange::runs)
    throw scene::bad_input("`exchange` runs: `compositor` gl-fragment takes ray segments; use `exchange` segments");
  if (on_device && settings.compositing_on.gl.method == compositor::GlMethod::fragment &&
      (settings.render.integrator.kind == scene::IntegratorKind::preintegrated ||
       settings.render.integrator.kind == scene::IntegratorKind::partial))
    throw scene::bad_input("`integrator`: `compositor` gl-fragment knows sampled:N, exact and auto; use one of these");
  const int self = transport.rank();
  std::optional<LoadedMesh> loaded;
  if (!jobs.empty()) {
    if (settings.roles.projects(self))
      loaded.emplace(settings, mesh_of).load(jobs.front().mesh);
    else
      static_cast<void>(mesh_of(jobs.front().mesh));
  }
  CompositingDevice device;
  open_compositing_device(settings.compositing_on, settings.roles, transport, settings.compositing, device);
  exchange::gather_all(transport, {});  // a frame's time does not count reading
  const DistributedRun run{transport, settings, jobs, function, device, std::chrono::steady_clock::now()};
  std::vector<std::function<void()>> parts;
  if (loaded)
    parts.emplace_back([&] { run_projector(run, *loaded); });
  else
    parts.emplace_back([&] { take_part_in_loading(run, mesh_of); });
  if (settings.roles.composites(self)) parts.emplace_back([&] { run_compositor(run); });
  if (settings.roles.assembler() == self) parts.emplace_back([&] { run_assembler(run, done); });

  // An error of any part is the run's: the others wake up with it.
  const auto guarded = [&](const std::function<void()>& part) {
    try {
      part();
    } catch (const std::exception& fault) {
      transport.fail(run_error(transport, fault));
    }
  };
  std::vector<std::thread> threads;
  guarded([&] {
    for (std::size_t i = 1; i < parts.size(); ++i)
      threads.push_back(scene::start_thread([&, i] { guarded(parts[i]); }));
    parts.front()();  // projection, where there is one, on the calling thread
  });
  for (auto& thread : threads) thread.join();
  transport.check();
}

}  // namespace tessera::frame
