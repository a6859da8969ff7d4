// SPDX-License-Identifier: BSD-3-Clause
#include "api/queries/verify.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "reference/grid/grid_reference.hpp"
#include "reference/grid/grid_suspicion.hpp"
#include "reference/image_suspicion.hpp"
#include "reference/mesh/mesh_suspicion.hpp"
#include "reference/reference.hpp"
#include "scene/error_budget.hpp"
#include "scene/threads.hpp"
#include "volume/image_sink.hpp"
#include "volume/precise/voxel_cast.hpp"

namespace tessera::api {
namespace {

using reference::Suspicion;
using reference::SuspicionMap;

/// The smallest suspicious difference: half of the bound or, without a bound, half of the default accuracy.
double least_suspicious(const std::optional<double>& bound) { return bound.value_or(Integrator().accuracy) / 2; }

/// Collects the suspicious pixels of an image, from which `count` pixels are chosen.
class Collector {
 public:
  Collector(scene::ImageSize size, std::size_t count) : size_(size), most_(count) {}

  void add(Suspicion kind, const SuspicionMap& map) {
    found_[static_cast<std::size_t>(kind)] = reference::ranked(map, size_, most_);
  }
  void add(const reference::ImageSuspicion& picture) {
    add(Suspicion::edge, picture.edge);
    add(Suspicion::outlier, picture.outlier);
    add(Suspicion::block, picture.block);
    add(Suspicion::plateau, picture.plateau);
  }
  [[nodiscard]] reference::Suspects take() { return std::move(found_); }

 private:
  scene::ImageSize size_;
  std::size_t most_;
  reference::Suspects found_;
};

/// Pixels with a large error bound whose rays were not cast again in double precision are the least certain. Pixels
/// whose rays were cast again are assumed to be exact.
SuspicionMap suspicion_of(std::span<const float> error_bounds, double tolerance) {
  SuspicionMap map(error_bounds.begin(), error_bounds.end());
  for (float& bound : map)
    if (bound > tolerance) bound = static_cast<float>(tolerance / 16);
  return map;
}

/// Casts the rays of the most suspicious pixels of a grid's image again, voxel by voxel in double precision. The
/// difference is the best available estimate of a pixel's error.
SuspicionMap second_opinion(const scene::Image& image, const scene::SampleSource& source, const scene::Camera& camera,
                            const scene::TransferFunction& function, const volume::RenderSettings& settings,
                            const reference::Suspects& suspects, std::size_t count) {
  std::vector<std::array<int, 2>> pixels;
  for (const reference::ChosenPixel& p : reference::by_turns(suspects, count)) pixels.push_back({p.at.x, p.at.y});
  // Neighbouring pixels share the samples that their rays read.
  std::sort(pixels.begin(), pixels.end(), [](const auto& a, const auto& b) {
    const auto place = [](const auto& p) { return std::array{p[1] / 32, p[0] / 32, p[1], p[0]}; };
    return place(a) < place(b);
  });
  scene::Image again(image.size);
  // The error to detect is as large as the bound.
  const double bound = promised_error(settings, DataKind::grid).value_or(Integrator().accuracy);
  const volume::GridSurfaces surfaces(settings.surfaces, function);
  const volume::VoxelCastSettings cast{{settings.emission, bound / 1000, bound / 64},
                                       settings.grid.shading,
                                       settings.clip,
                                       surfaces.any() ? &surfaces : nullptr};
  tbb::task_arena arena(scene::threads_for(settings.threads));
  arena.execute([&] {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<volume::UncertainRay> rays;
    rays.reserve(pixels.size());
    for (const auto& [x, y] : pixels) rays.push_back({x, y, -infinity, infinity, 0});
    scene::FrameWatch unwatched;
    volume::ImageSink sink(again, nullptr, unwatched);
    volume::VoxelCaster(source, camera, image.size, function, cast).cast(rays, sink);
  });
  SuspicionMap map(image.depth.size(), 0.0f);
  for (const auto& [x, y] : pixels)
    for (std::size_t pixel = image.index(x, y), c = 0; c < 4; ++c)
      map[pixel] = std::max(map[pixel], std::abs(image.rgba[4 * pixel + c] - again.rgba[4 * pixel + c]));
  return map;
}

bool checks_all(scene::ImageSize size, std::size_t count) {
  return count >= static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
}

}  // namespace

std::optional<double> promised_error(const Settings& settings, DataKind data) {
  const bool mesh = data == DataKind::mesh;
  const DeviceSettings& device = settings.mesh.device;
  if (mesh && settings.mesh.rasterizer == Rasterizer::scanline) return std::nullopt;
  if (mesh && !device.backends.empty() && device.method == GlMethod::fragment) return std::nullopt;
  switch (settings.integrator.kind) {
    case IntegratorKind::exact:
      return mesh ? scene::error_budget::exact_mesh : scene::error_budget::exact_grid;
    case IntegratorKind::automatic:
      return settings.integrator.accuracy;
    case IntegratorKind::sampled:
    case IntegratorKind::preintegrated:
    case IntegratorKind::partial:
      break;
  }
  return std::nullopt;
}

reference::Suspects suspects(const scene::Image& image, const scene::TetMeshView& mesh, const scene::Camera& camera,
                             const scene::TransferFunction& transfer_function, const Settings& settings,
                             std::size_t count) {
  if (checks_all(image.size, count)) return {};
  Collector collector(image.size, count);
  const auto picture =
      reference::suspect(image, least_suspicious(promised_error(settings, DataKind::mesh)), settings.threads);
  collector.add(picture);
  const auto scene =
      reference::suspect(mesh, camera, transfer_function, settings.emission, image, picture.edge, settings.threads);
  collector.add(Suspicion::step, scene.step);
  collector.add(Suspicion::tie, scene.tie);
  collector.add(Suspicion::depth, scene.depth);
  return collector.take();
}

reference::Suspects suspects(const scene::Image& image, const scene::SampleSource& source, const scene::Camera& camera,
                             const scene::TransferFunction& transfer_function, const volume::RenderSettings& settings,
                             std::span<const float> error_bounds, std::size_t count) {
  if (checks_all(image.size, count)) return {};
  Collector collector(image.size, count);
  const double least = least_suspicious(promised_error(settings, DataKind::grid));
  const auto picture = reference::suspect(image, least, settings.threads);
  collector.add(picture);
  const auto scene =
      reference::suspect(source, camera, transfer_function, settings.emission, image, picture.edge, settings.threads);
  collector.add(Suspicion::step, scene.step);
  collector.add(Suspicion::border, scene.border);
  collector.add(Suspicion::tie, scene.tie);
  collector.add(Suspicion::estimate, suspicion_of(error_bounds, least));
  reference::Suspects found = collector.take();
  // Images of rectilinear grids are already rendered voxel by voxel in double precision.
  if (source.geometry().rectilinear() || !promised_error(settings, DataKind::grid)) return found;
  const SuspicionMap again = second_opinion(image, source, camera, transfer_function, settings, found, count);
  found[static_cast<std::size_t>(Suspicion::estimate)] = reference::ranked(again, image.size, count);
  return found;
}

double layer_bound(const std::optional<double>& promised) {
  constexpr double most = scene::error_budget::exact_layers;
  return std::min(promised.value_or(most), most);
}

namespace {

/// Compares the image and, if there are any, its layers with the reference.
template <class Reference>
Verified judged(const scene::Image& image, const Layers& layers, const Reference& reference,
                const std::optional<double>& promised, std::size_t count, const reference::Suspects& where,
                int threads) {
  Verified verified{reference::verify(image, reference, promised, count, where, threads), {}};
  if (layers.peel)
    verified.layers =
        reference::verify_layers(layers.images, reference, *layers.peel, layer_bound(promised), count, where, threads);
  return verified;
}

}  // namespace

Verified verify_all(const scene::Image& image, const Layers& layers, const frame::UncutMesh& mesh,
                    const scene::Camera& camera, const scene::TransferFunction& transfer_function,
                    const Settings& settings, std::size_t count) {
  const reference::Suspects where = suspects(image, mesh.rendered, camera, transfer_function, settings, count);
  const reference::Reference reference(mesh.mesh, camera, image.size, transfer_function, settings.emission,
                                       settings.surfaces, mesh.kept, settings.mesh.shading);
  return judged(image, layers, reference, promised_error(settings, DataKind::mesh), count, where, settings.threads);
}

Verified verify_all(const scene::Image& image, const Layers& layers, const scene::SampleSource& source,
                    const scene::Camera& camera, const scene::TransferFunction& transfer_function,
                    const volume::RenderSettings& settings, std::span<const float> error_bounds, std::size_t count) {
  const reference::Suspects where = suspects(image, source, camera, transfer_function, settings, error_bounds, count);
  const reference::GridReference reference(source, camera, image.size, transfer_function, settings.emission,
                                           settings.grid.shading, settings.clip, settings.surfaces);
  return judged(image, layers, reference, promised_error(settings, DataKind::grid), count, where, settings.threads);
}

reference::Verification verify(const scene::Image& image, const frame::UncutMesh& mesh, const scene::Camera& camera,
                               const scene::TransferFunction& transfer_function, const Settings& settings,
                               std::size_t count) {
  return verify_all(image, {}, mesh, camera, transfer_function, settings, count).picture;
}

reference::Verification verify(const scene::Image& image, const scene::SampleSource& source,
                               const scene::Camera& camera, const scene::TransferFunction& transfer_function,
                               const volume::RenderSettings& settings, std::span<const float> error_bounds,
                               std::size_t count) {
  return verify_all(image, {}, source, camera, transfer_function, settings, error_bounds, count).picture;
}

}  // namespace tessera::api
