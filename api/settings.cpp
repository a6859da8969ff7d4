// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "frame/mesh/peel.hpp"
#include "frame/mesh/render.hpp"
#include "integrals/segment_integrator.hpp"
#include "scene/error.hpp"
#include "scene/error_budget.hpp"
#include "scene/surface_set.hpp"
#include "volume/render.hpp"

namespace tessera {
inline namespace v0_1 {

Exchange exchange_of(const Settings& settings, bool deep) {
  if (settings.ranks.exchange) return *settings.ranks.exchange;
  const bool is_near = settings.integrator.kind == IntegratorKind::automatic &&
                       !scene::error_budget::runs_keep(settings.integrator.accuracy, settings.mesh.shading.has_value());
  const bool wants_segments =
      settings.mesh.rasterizer == Rasterizer::scanline || deep || !settings.mesh.device.backends.empty() || is_near;
  return wants_segments ? Exchange::segments : Exchange::runs;
}

namespace {

template <class Number>
void require_range(const char* setting, Number value, Number least, Number most, const char* allowed) {
  if (!(value >= least && value <= most))
    throw scene::bad_input(fmt::format("`{}` {}: it must be {}", setting, value, allowed));
}

void check_shading(const Shading& shading, Emission emission) {
  if (emission == Emission::independent)
    throw scene::bad_input("`shade`: shading does not support `emission` independent; leave one of the two out");
  const double length = glm::length(shading.to_light);
  if (!(length > 0) || !std::isfinite(length))
    throw scene::bad_input("`light`: the direction to the light has no length; give the direction towards the light");
  for (const double part : {shading.ambient, shading.diffuse, shading.specular, shading.shininess})
    if (!(part >= 0) || !std::isfinite(part))
      throw scene::bad_input("`shade`: the components of the lighting must be finite and 0 or more");
}

void check_integrator_of_mesh(const Integrator& integrator, Emission emission) {
  if (integrator.kind == IntegratorKind::sampled && integrator.samples < 1)
    throw scene::bad_input(
        fmt::format("`integrator` sampled:{}: the number of samples must be at least 1", integrator.samples));
  if (integrator.kind == IntegratorKind::preintegrated && (integrator.table_size < 8 || integrator.table_size > 512))
    throw scene::bad_input(
        fmt::format("`integrator` preintegrated:{}: the table's size must be 8 to 512", integrator.table_size));
  if (integrator.kind == IntegratorKind::partial && emission == Emission::independent)
    throw scene::bad_input("`integrator` partial: it supports only `emission` absorption; use exact or auto");
}

void check_device_rasterizer(const DeviceSettings& device) {
  const auto on_cpu = std::ranges::count(device.backends, Backend::cpu);
  if (on_cpu == std::ssize(device.backends))
    throw scene::bad_input(
        "`rasterizer` device: it is for `compositor` gl-compute; add that, or use `rasterizer` planes");
  if (on_cpu > 0)
    throw scene::bad_input(
        "`rasterizer` device: `backend` leaves some compositors to the CPU; name a device for each, or use "
        "`rasterizer` planes");
  if (device.method == GlMethod::fragment)
    throw scene::bad_input(
        "`rasterizer` device: `compositor` gl-fragment takes ray segments; use gl-compute, or `rasterizer` planes");
}

void check_mesh(const Settings& settings) {
  require_range("tile_size", settings.mesh.tile_size, 1, 1024, "1 to 1024 pixels");
  check_integrator_of_mesh(settings.integrator, settings.emission);
  if (settings.mesh.rasterizer == Rasterizer::scanline && !settings.surfaces.empty())
    throw scene::bad_input(fmt::format("{}: `rasterizer` scanline does not support surfaces; use `rasterizer` planes",
                                       frame::surface_word(settings.surfaces)));
  if (settings.mesh.rasterizer == Rasterizer::scanline && settings.mesh.shading)
    throw scene::bad_input("`shade`: `rasterizer` scanline does not support shading; use `rasterizer` planes");
  if (settings.mesh.shading) check_shading(*settings.mesh.shading, settings.emission);
  if (settings.mesh.rasterizer == Rasterizer::device) check_device_rasterizer(settings.mesh.device);
}

void check_grid(const Settings& settings) {
  const IntegratorKind kind = settings.integrator.kind;
  if (settings.surfaces.has_faces())
    throw scene::bad_input(fmt::format("{}: it is for meshes, but the data set is a grid; leave it out",
                                       frame::surface_word(settings.surfaces)));
  if (kind == IntegratorKind::partial)
    throw scene::bad_input("`integrator` partial: it is for meshes, but the data set is a grid; use auto or exact");
  if (settings.mesh.rasterizer != Rasterizer::planes)
    throw scene::bad_input("`rasterizer`: it is for meshes, but the data set is a grid; leave it out");
  require_range("brick_size", settings.grid.brick_size, 2, 1 << 16, "2 to 65536 voxels");
  if (!(settings.grid.step > 0) || !std::isfinite(settings.grid.step))
    throw scene::bad_input(fmt::format("`step` {}: it must be positive, in voxels", settings.grid.step));
  if (settings.grid.preload_limit < 0)
    throw scene::bad_input(fmt::format("`preload` {}: it must be 0 or more", settings.grid.preload_limit));
  if (settings.grid.shading && volume::in_steps(kind))
    throw scene::bad_input("`shade`: shading needs the exact or auto method; leave one of the two out");
  if (settings.grid.shading) check_shading(*settings.grid.shading, settings.emission);
  if (!settings.surfaces.empty() && volume::in_steps(kind))
    throw scene::bad_input("`iso`: iso-surfaces need the exact or auto method; leave one of the two out");
  if (kind == IntegratorKind::preintegrated && settings.emission == Emission::independent)
    throw scene::bad_input(
        "`integrator`: pre-integration needs emission that is proportional to extinction; use sampled or exact");
  if (kind == IntegratorKind::preintegrated && settings.ranks.distribution == Distribution::sort_last)
    throw scene::bad_input(
        "`distribution` sort-last: a pre-integrated step from one process's part to the next would be missed; use "
        "`integrator` auto, exact or sampled, or sort-first");
}

}  // namespace

void validate(const Settings& settings, DataKind data) {
  require_range("threads", settings.threads, 0, 1024, "0 (all cores) to 1024");
  if (settings.integrator.kind == IntegratorKind::automatic) scene::check_accuracy(settings.integrator.accuracy);
  scene::validate(settings.surfaces);
  if (settings.ranks.frames_in_flight < 1)
    throw scene::bad_input(
        fmt::format("`frames_in_flight` {}: it must be at least 1", settings.ranks.frames_in_flight));
  data == DataKind::mesh ? check_mesh(settings) : check_grid(settings);
}

void validate(const FrameSettings& frame, const Settings& settings, DataKind data) {
  if (!frame.by_depth()) return;
  const char* const what = frame::deep_word(frame.peel.has_value());
  require_range("deep_accuracy", frame.deep_accuracy, 1e-6, 1., "1e-6 to 1");
  if (frame.peel && !(frame.peel->threshold > 0 && frame.peel->threshold < 1))
    throw scene::bad_input(fmt::format("`peel` {}: the threshold must be above 0 and below 1", frame.peel->threshold));
  if (frame.peel && (frame.peel->layers < 1 || frame.peel->layers > 64))
    throw scene::bad_input(fmt::format("`peel`: {} layers; there may be 1 to 64", frame.peel->layers));
  const IntegratorKind kind = settings.integrator.kind;
  const bool exact = kind == IntegratorKind::exact || kind == IntegratorKind::automatic;
  if (data == DataKind::grid && !exact)
    throw scene::bad_input(
        fmt::format("{}: cutting a step along a ray changes its colour; set `integrator` auto or exact", what));
  if (data == DataKind::grid && settings.grid.shading && !frame.peel)
    throw scene::bad_input("deep image: shading is not supported; leave `shade` out");
  if (data == DataKind::mesh && settings.mesh.rasterizer == Rasterizer::scanline)
    throw scene::bad_input(
        fmt::format("{}: `rasterizer` scanline leaves gaps and overlaps in depth; use planes", what));
  if (data == DataKind::mesh && !exact)
    throw scene::bad_input(fmt::format(
        "{}: with `integrator` {}, cutting a ray segment changes its colour; use exact or auto", what,
        integrals::SegmentIntegrator(TransferFunction({Knot{}}), settings.integrator, settings.emission).name()));
}

}  // namespace v0_1
}  // namespace tessera
