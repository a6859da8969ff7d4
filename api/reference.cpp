// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/reference.hpp"

#include <utility>

#include "api/dataset.hpp"
#include "api/selected_dataset.hpp"
#include "reference/grid/grid_reference.hpp"
#include "reference/reference.hpp"
#include "scene/error.hpp"

namespace tessera {
inline namespace v0_1 {

struct Reference::State {
  Dataset dataset;
  frame::UncutMesh mesh;  ///< empty for a grid
  std::unique_ptr<const reference::RayReference> rays;
};

namespace {

std::unique_ptr<const reference::RayReference> rays_of(const Dataset& dataset, const frame::UncutMesh& mesh,
                                                       const View& view, const TransferFunction& function,
                                                       const Settings& settings) {
  const Dataset::State& data = StateAccess::of(dataset);
  if (dataset.is_grid())
    return std::make_unique<reference::GridReference>(*data.samples, view.camera, view.size, function,
                                                      settings.emission, settings.grid.shading, data.clip,
                                                      settings.surfaces);
  return std::make_unique<reference::Reference>(mesh.mesh, view.camera, view.size, function, settings.emission,
                                                settings.surfaces, mesh.kept, settings.mesh.shading);
}

}  // namespace

Reference::Reference(Dataset dataset, const View& view, const TransferFunction& transfer_function,
                     const Settings& settings) {
  const Dataset::State& data = StateAccess::of(dataset);
  if (data.ranks > 1)
    throw scene::bad_input(data.source + ": this rank has a part of the mesh; open it on one rank to judge images");
  frame::UncutMesh mesh;
  if (dataset.is_mesh()) mesh = api::uncut_mesh(data);
  auto rays = rays_of(dataset, mesh, view, transfer_function, settings);
  state_ = std::make_unique<const State>(State{std::move(dataset), std::move(mesh), std::move(rays)});
}

Reference::~Reference() = default;

std::vector<ReferencePixel> Reference::pixels(std::span<const PixelIndex> wanted, int threads) const {
  return state_->rays->pixels(wanted, threads);
}

}  // namespace v0_1
}  // namespace tessera
