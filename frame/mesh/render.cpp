// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/render.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "compositor/deep/deep_collector.hpp"
#include "compositor/deep/deep_sink.hpp"
#include "compositor/deep/peel_sink.hpp"
#include "compositor/matter_light.hpp"
#include "compositor/picture_sink.hpp"
#include "frame/mesh/boundary_faces.hpp"
#include "frame/mesh/frame_projector.hpp"
#include "frame/mesh/lattice_frame.hpp"
#include "frame/mesh/peel.hpp"
#include "integrals/segment_integrator.hpp"
#include "projection/planes_rasterizer.hpp"
#include "scene/error.hpp"
#include "scene/threads.hpp"

namespace tessera::frame {
void check_deep(const RenderSettings& settings, const scene::TransferFunction& function) {
  const char* const what = deep_word(settings.peel.has_value());
  if (!(settings.deep_accuracy >= 1e-6 && settings.deep_accuracy <= 1))
    throw scene::bad_input(fmt::format("`deep_accuracy` {}: it must be 1e-6 to 1", settings.deep_accuracy));
  if (settings.rasterizer == Rasterizer::scanline)
    throw scene::bad_input(
        fmt::format("{}: `rasterizer` scanline leaves gaps and overlaps in depth; use planes", what));
  const integrals::SegmentIntegrator integrator(function, settings.integrator, settings.emission);
  if (integrator.name() != "exact")
    throw scene::bad_input(fmt::format(
        "{}: `integrator` {} gives a segment other light than its parts; use exact or auto", what, integrator.name()));
}

const char* surface_word(const scene::Surfaces& surfaces) { return surfaces.has_faces() ? "`surface`" : "`iso`"; }

void check_surfaces(const RenderSettings& settings, scene::Association association) {
  const scene::Surfaces& surfaces = settings.surfaces;
  scene::validate(surfaces);
  if (surfaces.empty()) return;
  if (settings.rasterizer == Rasterizer::scanline)
    throw scene::bad_input(
        fmt::format("{}: `rasterizer` scanline knows no surfaces; use `rasterizer` planes", surface_word(surfaces)));
  if (association == scene::Association::cell && !surfaces.iso.empty())
    throw scene::bad_input(
        "`iso`: the field has one value a cell, so no iso-surfaces; use `smooth`, or a `field` with values at points");
}

void check_shading(const RenderSettings& settings) {
  if (!settings.shading) return;
  const scene::Shading& shading = *settings.shading;
  if (settings.rasterizer == Rasterizer::scanline)
    throw scene::bad_input("`shade`: `rasterizer` scanline knows no shading; use `rasterizer` planes");
  if (settings.emission == scene::Emission::independent)
    throw scene::bad_input("`shade`: shading needs emission in proportion to extinction; leave one of the two out");
  const double length = glm::length(shading.to_light);
  if (!(length > 0) || !std::isfinite(length))
    throw scene::bad_input("`light`: the direction to the light has no length; say which way the light lies");
  for (const double part : {shading.ambient, shading.diffuse, shading.specular, shading.shininess})
    if (!(part >= 0) || !std::isfinite(part))
      throw scene::bad_input("`shade`: the parts of the light must be 0 or more, and finite");
}

struct Renderer::State {
  State(const scene::TetMeshView& mesh, const RenderSettings& s)
      : settings(s), projector(mesh, s), scalar_range(scene::scalar_range(mesh, s.threads)), normals(mesh) {
    find_boundary(mesh);
  }
  State(const std::shared_ptr<const projection::PreparedMesh>& mesh, const scene::MeshFacts& facts,
        const RenderSettings& s)
      : settings(s), projector(mesh, facts.box, s), scalar_range(facts.scalar_range), normals(mesh->mesh()) {
    find_boundary(mesh->mesh());
  }

  void find_boundary(const scene::TetMeshView& mesh) {
    if (settings.surfaces.boundary.empty()) return;
    const scene::TraceScope timing(settings.trace, "prepare");
    boundary = tbb::task_arena(scene::threads_for(settings.threads)).execute([&] { return boundary_faces(mesh); });
  }

  /// The integrator of this function. Its tables are kept for as long as the function stays.
  const integrals::SegmentIntegrator& integrator(const scene::TransferFunction& f) {
    if (!kept || !std::ranges::equal(f.knots(), function.knots())) {
      kept.emplace(f, settings.integrator, settings.emission);
      function = f;
    }
    return *kept;
  }

  RenderSettings settings;
  FrameProjector projector;
  std::array<double, 2> scalar_range;
  compositor::MeshNormals normals;
  std::optional<BoundaryFaces> boundary;  ///< if the settings have surfaces of it
  scene::TransferFunction function;
  std::optional<integrals::SegmentIntegrator> kept;
};

Renderer::Renderer(const scene::TetMeshView& mesh, const RenderSettings& settings)
    : state_(std::make_unique<State>(mesh, settings)) {}

Renderer::Renderer(const std::shared_ptr<const projection::PreparedMesh>& mesh, const scene::MeshFacts& facts,
                   const RenderSettings& settings)
    : state_(std::make_unique<State>(mesh, facts, settings)) {}

Renderer::~Renderer() = default;

void Renderer::set_deep(double accuracy, const std::optional<Peel>& peel) {
  state_->settings.deep_accuracy = accuracy;
  state_->settings.peel = peel;
}

scene::Image Renderer::render(const scene::Camera& camera, scene::ImageSize size,
                              const scene::TransferFunction& transfer_function, FrameStatistics* statistics,
                              scene::DeepImage* deep, scene::FrameWatch* watch) {
  const RenderSettings& settings = state_->settings;
  const projection::PixelSpace space(camera, size);
  const integrals::SegmentIntegrator& integrator = state_->integrator(transfer_function);
  scene::Image image;
  FrameProjector::Task task;
  task.beside = [&] { image = scene::Image(size); };  // whose pages are new, so slow to fill
  task.space = &space;
  task.grid = {size, settings.tile_size};
  task.function = &transfer_function;
  task.watch = watch;
  task.image = &image;
  scene::SurfaceSet surfaces(settings.surfaces, transfer_function);
  task.surfaces = &surfaces;
  const std::vector<projection::SurfaceFaces> faces =
      faces_of(settings.surfaces, surfaces, state_->boundary ? &*state_->boundary : nullptr);
  task.faces = faces;
  const double longest_ray = state_->projector.diagonal();
  std::optional<compositor::DeepCollector> collector;
  if (deep != nullptr) {
    check_deep(settings, transfer_function);
    task.kept_bytes = settings.memory_bytes / 2;
    collector.emplace(size, task.kept_bytes);
  }
  std::optional<compositor::MatterLight> light;
  if (settings.shading) light.emplace(*settings.shading, camera);
  const double max_color = light ? light->brightest(transfer_function.max_color()) : transfer_function.max_color();
  compositor::TileScene scene{
      &space, &integrator,
      std::max(integrals::opacity_weight(max_color, longest_ray, settings.emission), surfaces.max_color())};
  if (!surfaces.empty()) scene.surfaces = &surfaces;
  if (light) scene.light = &*light, scene.normals = &state_->normals;
  const compositor::ImageWindow window{&image};
  task.make_sink = [&]() -> std::unique_ptr<compositor::TileSink<sorting::DoubleEncoding>> {
    if (!collector) return std::make_unique<compositor::PictureSink<sorting::DoubleEncoding>>(scene, window);
    if (settings.peel)
      return std::make_unique<compositor::PeelSink>(scene, window, transfer_function, settings.emission, *settings.peel,
                                                    *collector);
    return std::make_unique<compositor::DeepSink>(scene, window, transfer_function, settings.emission,
                                                  settings.deep_accuracy, *collector);
  };
  const std::optional<scene::Lattice> lattice =
      collector ? std::nullopt
                : lattice_of(space, state_->projector.box(), state_->scalar_range, transfer_function, settings);
  std::optional<integrals::LaneTable> table;
  if (lattice) {
    table.emplace(transfer_function, *lattice, settings.emission);
    surfaces.place_on(*lattice);
    scene.table = &*table;
    scene.lattice = *lattice;
    task.lattice = &*lattice;
    task.make_lattice_sink = [&] {
      return std::make_unique<compositor::PictureSink<sorting::LatticeEncoding>>(scene, window);
    };
  }
  FrameStatistics counted = state_->projector.project(task);
  counted.instruction_set = projection::instruction_set();
  counted.integrator = integrator.name();
  if (collector) {
    *deep = collector->image();
    counted.deep_samples = deep->samples.size();
  }
  if (statistics != nullptr) *statistics = counted;
  return image;
}

}  // namespace tessera::frame
