// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/render.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "compositor/deep/deep_collector.hpp"
#include "compositor/deep/deep_sink.hpp"
#include "compositor/deep/lattice_deep_sink.hpp"
#include "compositor/deep/layer_sink.hpp"
#include "compositor/deep/peel_sink.hpp"
#include "compositor/picture_sink.hpp"
#include "frame/mesh/boundary_faces.hpp"
#include "frame/mesh/frame_projector.hpp"
#include "frame/mesh/lattice_frame.hpp"
#include "integrals/segment_integrator.hpp"
#include "projection/matter_light.hpp"
#include "projection/planes_rasterizer.hpp"
#include "scene/threads.hpp"

namespace tessera::frame {

const char* surface_word(const Surfaces& surfaces) { return surfaces.has_faces() ? "`surface`" : "`iso`"; }

struct Renderer::State {
  State(const scene::TetMeshView& mesh, const Settings& s)
      : settings(s),
        projector(mesh, s),
        scalar_range(scene::with_threads(s.threads, [&] { return scene::scalar_range(mesh); })),
        normals(mesh) {
    find_boundary(mesh);
  }
  State(const std::shared_ptr<const projection::PreparedMesh>& mesh, const scene::MeshFacts& facts, const Settings& s)
      : settings(s), projector(mesh, facts.box, s), scalar_range(facts.scalar_range), normals(mesh->mesh()) {
    find_boundary(mesh->mesh());
  }

  void find_boundary(const scene::TetMeshView& mesh) {
    if (settings.surfaces.boundary.empty()) return;
    const scene::TraceScope timing(settings.trace, "prepare");
    boundary = scene::with_threads(settings.threads, [&] { return boundary_faces(mesh); });
  }

  /// Returns the integrator of this function. Its tables are kept until the function or the accuracy changes.
  const integrals::SegmentIntegrator& integrator(const scene::TransferFunction& f, const scene::Integrator& how) {
    if (!kept || !std::ranges::equal(f.knots(), function.knots()) || how.accuracy != accuracy) {
      kept.emplace(f, how, settings.emission);
      function = f;
      accuracy = how.accuracy;
    }
    return *kept;
  }

  Settings settings;
  FrameSettings frame;
  FrameProjector projector;
  std::array<double, 2> scalar_range;
  projection::MeshNormals normals;
  std::optional<BoundaryFaces> boundary;  ///< if the settings have boundary surfaces
  scene::TransferFunction function;
  double accuracy = 0;
  std::optional<integrals::SegmentIntegrator> kept;
};

Renderer::Renderer(const scene::TetMeshView& mesh, const Settings& settings)
    : state_(std::make_unique<State>(mesh, settings)) {}

Renderer::Renderer(const std::shared_ptr<const projection::PreparedMesh>& mesh, const scene::MeshFacts& facts,
                   const Settings& settings)
    : state_(std::make_unique<State>(mesh, facts, settings)) {}

Renderer::~Renderer() = default;

void Renderer::set_frame(const FrameSettings& frame) { state_->frame = frame; }

scene::Image Renderer::render(const scene::Camera& camera, scene::ImageSize size,
                              const scene::TransferFunction& transfer_function, FrameStatistics* statistics,
                              scene::DeepImage* deep, scene::FrameWatch* watch) {
  const Settings& settings = state_->settings;
  const FrameSettings& frame = state_->frame;
  const projection::PixelSpace space(camera, size);
  FrameSettings by_depth;
  if (deep != nullptr) by_depth = {.deep = true, .deep_accuracy = frame.deep_accuracy, .peel = frame.peel};
  const integrals::SegmentIntegrator& integrator =
      state_->integrator(transfer_function, integrator_of(settings, by_depth));
  scene::Image image;
  scene::SurfaceSet surfaces(settings.surfaces, transfer_function);
  const std::vector<projection::SurfaceFaces> faces =
      faces_of(settings.surfaces, surfaces, state_->boundary ? &*state_->boundary : nullptr);
  const double longest_ray = state_->projector.diagonal();
  std::optional<compositor::DeepCollector> collector;
  if (deep != nullptr) collector.emplace(size, settings.memory_bytes / 2);
  std::optional<projection::MatterLight> light;
  if (settings.mesh.shading) light.emplace(*settings.mesh.shading, camera);
  const double max_color = light ? light->brightest(transfer_function.max_color()) : transfer_function.max_color();
  compositor::TileScene scene{
      &space, &integrator,
      std::max(integrals::opacity_weight(max_color, longest_ray, settings.emission), surfaces.max_color())};
  if (!surfaces.empty()) scene.surfaces = &surfaces;
  if (light) scene.light = &*light, scene.normals = &state_->normals;
  const compositor::ImageWindow window{&image};
  const auto sink_in_double = [&]() -> std::unique_ptr<compositor::TileSink<sorting::DoubleEncoding>> {
    if (!collector) return std::make_unique<compositor::PictureSink<sorting::DoubleEncoding>>(scene, window);
    if (frame.peel)
      return std::make_unique<compositor::PeelSink>(scene, window, transfer_function, settings.emission, *frame.peel,
                                                    *collector);
    return std::make_unique<compositor::DeepSink>(scene, window, transfer_function, settings.emission,
                                                  frame.deep_accuracy, *collector);
  };
  const std::optional<FrameLattice> lattice =
      lattice_of(space, state_->projector.box(), state_->scalar_range, transfer_function, settings, by_depth);
  const auto sink_on_lattice = [&]() -> std::unique_ptr<compositor::TileSink<sorting::LatticeEncoding>> {
    if (!collector) return std::make_unique<compositor::PictureSink<sorting::LatticeEncoding>>(scene, window);
    if (!frame.peel)
      return std::make_unique<compositor::LatticeDeepSink>(scene, window, frame.deep_accuracy, *collector);
    return std::make_unique<compositor::LayerSink>(scene, window, lattice->function, *frame.peel, *collector);
  };
  std::optional<integrals::LaneTable> table;
  if (lattice) {
    table.emplace(lattice->function, lattice->lattice, settings.emission);
    surfaces.place_on(lattice->lattice);
    scene.table = &*table;
    scene.lattice = lattice->lattice;
  }
  FrameStatistics counted =
      state_->projector.project({.space = &space,
                                 .grid = {size, settings.mesh.tile_size},
                                 .function = &transfer_function,
                                 .surfaces = &surfaces,
                                 .faces = faces,
                                 .lattice = lattice ? &lattice->lattice : nullptr,
                                 .magnified = lattice ? std::span<const scene::MagnifiedRange>(lattice->magnified)
                                                      : std::span<const scene::MagnifiedRange>(),
                                 .light = light ? &*light : nullptr,
                                 .watch = watch},
                                {.in_double = sink_in_double,
                                 .on_lattice = sink_on_lattice,
                                 .kept_bytes = collector ? settings.memory_bytes / 2 : 0,
                                 .image = &image,
                                 .prepare = [&] { image = scene::Image(size); }});  // new pages are slow to fill
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
