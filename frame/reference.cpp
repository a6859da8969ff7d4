#include "tessera/reference.hpp"

#include <utility>

#include "frame/dataset.hpp"
#include "reference/grid_reference.hpp"
#include "reference/reference.hpp"
#include "scene/error.hpp"

namespace tessera {

struct Reference::State {
  Dataset dataset;
  std::unique_ptr<const reference::RayReference> rays;
};

namespace {

std::unique_ptr<const reference::RayReference> rays_of(const Dataset& dataset, const View& view,
                                                       const TransferFunction& function, const Settings& settings) {
  const Dataset::State& data = dataset.state();
  if (dataset.is_grid())
    return std::make_unique<reference::GridReference>(*data.samples, view.camera, view.size, function,
                                                      settings.emission, settings.grid.shading);
  if (data.ranks > 1)
    throw scene::bad_input(data.source + ": this rank has a part of the mesh; open it on one rank to judge pictures");
  return std::make_unique<reference::Reference>(data.mesh, view.camera, view.size, function, settings.emission,
                                                settings.surfaces);
}

}  // namespace

Reference::Reference(Dataset dataset, const View& view, const TransferFunction& transfer_function,
                     const Settings& settings) {
  auto rays = rays_of(dataset, view, transfer_function, settings);
  state_ = std::make_unique<const State>(State{std::move(dataset), std::move(rays)});
}

Reference::~Reference() = default;

std::vector<ReferencePixel> Reference::pixels(std::span<const PixelIndex> wanted, int threads) const {
  return state_->rays->pixels(wanted, threads);
}

}  // namespace tessera
