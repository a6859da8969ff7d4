#include "frame/render.hpp"

#include "compositor/segment_integrator.hpp"
#include "compositor/tile_pixels.hpp"
#include "frame/frame_projector.hpp"
#include "projection/planes_rasterizer.hpp"

namespace tessera::frame {

struct Renderer::State {
  State(const scene::TetMesh& mesh, const RenderSettings& s) : settings(s), projector(mesh, s) {}

  RenderSettings settings;
  FrameProjector projector;
};

Renderer::Renderer(const scene::TetMesh& mesh, const RenderSettings& settings)
    : state_(std::make_unique<State>(mesh, settings)) {}

Renderer::~Renderer() = default;

scene::Image Renderer::render(const scene::Camera& camera, scene::ImageSize size,
                              const scene::TransferFunction& transfer_function, FrameStatistics* statistics) {
  const RenderSettings& settings = state_->settings;
  const projection::PixelSpace space(camera, size);
  const compositor::SegmentIntegrator integrator(transfer_function, settings.integrator, settings.emission,
                                                 settings.trace);
  scene::Image image(size);
  FrameProjector::Task task;
  task.space = &space;
  task.grid = {size, settings.tile_size};
  task.function = &transfer_function;
  task.make_sink = [&] {
    return std::make_unique<compositor::TilePixels>(space, integrator, transfer_function.max_color(),
                                                    state_->projector.diagonal(), settings.emission,
                                                    compositor::ImageWindow{&image});
  };
  FrameStatistics counted = state_->projector.project(task);
  counted.instruction_set = projection::instruction_set();
  counted.integrator = integrator.name();
  if (statistics != nullptr) *statistics = counted;
  return image;
}

}  // namespace tessera::frame
