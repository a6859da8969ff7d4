// SPDX-License-Identifier: BSD-3-Clause
#include "api/session_settings.hpp"

#include <fmt/format.h>

#include "scene/error.hpp"
#include "scene/error_budget.hpp"

namespace tessera::api {
namespace {

volume::Method method_of(IntegratorKind kind) {
  switch (kind) {
    case IntegratorKind::automatic:
      return volume::Method::automatic;
    case IntegratorKind::exact:
      return volume::Method::exact;
    case IntegratorKind::sampled:
      return volume::Method::sampled;
    case IntegratorKind::preintegrated:
      return volume::Method::preintegrated;
    case IntegratorKind::partial:
      break;
  }
  throw scene::bad_input("`integrator` partial: is for meshes, and the data set is a grid; use automatic or exact");
}

}  // namespace
}  // namespace tessera::api

namespace tessera {
inline namespace v0_1 {

Exchange exchange_of(const Settings& settings, bool deep) {
  if (settings.ranks.exchange) return *settings.ranks.exchange;
  const bool is_near = settings.integrator.kind == IntegratorKind::automatic &&
                       !scene::error_budget::runs_keep(settings.integrator.accuracy);
  const bool wants_segments =
      settings.mesh.rasterizer == Rasterizer::scanline || deep || !settings.mesh.device.backends.empty() || is_near;
  return wants_segments ? Exchange::segments : Exchange::runs;
}

}  // namespace v0_1
}  // namespace tessera

namespace tessera::api {

frame::RenderSettings mesh_settings(const Settings& s) {
  frame::RenderSettings settings;
  settings.rasterizer = s.mesh.rasterizer;
  settings.integrator = s.integrator;
  settings.emission = s.emission;
  settings.surfaces = s.surfaces;
  settings.shading = s.mesh.shading;
  settings.use = s.use;
  settings.threads = s.threads;
  settings.tile_size = s.mesh.tile_size;
  settings.memory_bytes = s.memory_bytes;
  // As Juliachs et al. 2007 printed it: the error is only reported.
  settings.bounded = s.mesh.device.backends.empty() || s.mesh.device.method != GlMethod::fragment;
  return settings;
}

volume::RenderSettings grid_settings(const Settings& s) {
  if (s.surfaces.has_faces())
    throw scene::bad_input(
        fmt::format("{}: is for meshes, and the data set is a grid; leave it out", frame::surface_word(s.surfaces)));
  volume::RenderSettings settings;
  settings.method = method_of(s.integrator.kind);
  settings.accuracy = s.integrator.accuracy;
  settings.step = s.grid.step;
  settings.emission = s.emission;
  settings.shading = s.grid.shading;
  settings.surfaces = s.surfaces;
  settings.threads = s.threads;
  settings.brick_size = s.grid.brick_size;
  settings.edge_bricks = s.grid.edge_bricks;
  settings.memory_bytes = s.memory_bytes;
  settings.cache = s.grid.cache;
  settings.preload_limit = s.grid.preload_limit;
  settings.use = s.use;
  return settings;
}

frame::SortFirstSettings sort_first_settings(const Settings& s) {
  frame::SortFirstSettings settings;
  settings.balance = s.ranks.balance;
  settings.resolution = s.ranks.balance_resolution;
  settings.weights = s.ranks.balance_weights;
  settings.measured = s.ranks.balance_measured;
  settings.threads = s.threads;
  return settings;
}

frame::CompositingSettings compositing_settings(const DeviceSettings& s) {
  frame::CompositingSettings settings;
  settings.backends = s.backends;
  settings.gl.method = s.method;
  settings.gl.half = s.half;
  settings.gl.by_local_rank = s.by_local_rank;
  settings.gl.egl_device.number = s.egl_device;
  return settings;
}

frame::DistributedSettings distributed_settings(const Settings& s, int ranks) {
  frame::DistributedSettings settings;
  settings.render = mesh_settings(s);
  settings.roles = assign_roles(ranks, s.ranks.projectors, s.ranks.compositors);
  settings.exchange = exchange_of(s, false);
  settings.frames_in_flight = s.ranks.frames_in_flight;
  settings.compositing_on = compositing_settings(s.mesh.device);
  settings.tile_seed = s.ranks.tile_seed;
  settings.share_memory = s.use.sharing;
  return settings;
}

}  // namespace tessera::api
