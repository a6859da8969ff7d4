// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "frame/mesh/uncut_mesh.hpp"
#include "reference/layer_verification.hpp"
#include "reference/verification.hpp"
#include "scene/camera.hpp"
#include "scene/image.hpp"
#include "scene/sample_source.hpp"
#include "scene/tet_mesh.hpp"
#include "scene/transfer_function.hpp"
#include "volume/render.hpp"

namespace tessera::api {

/// The largest error that is promised, in linear RGBA: with `exact` 2e-5 for meshes and 1e-5 for grids, with
/// `automatic` the requested accuracy. None for methods that take steps or samples, with the scanline rasterizer, or
/// composited as printed (gl-fragment): their error is only reported.
std::optional<double> promised_error(const Settings& settings, DataKind data);

/// Where to check a finished image if `count` of its pixels are judged: where the image itself, the scene and the
/// frame's own estimates make it least certain (reference/suspicion.hpp). Depends only on the arguments, except the
/// number of threads, so that a second run, on any number of ranks, checks the same pixels.
reference::Suspects suspects(const scene::Image& image, const scene::TetMeshView& mesh, const scene::Camera& camera,
                             const scene::TransferFunction& transfer_function, const Settings& settings,
                             std::size_t count);

/// `error_bounds`: by pixel, from volume::Renderer::render; may be empty.
reference::Suspects suspects(const scene::Image& image, const scene::SampleSource& source, const scene::Camera& camera,
                             const scene::TransferFunction& transfer_function, const volume::RenderSettings& settings,
                             std::span<const float> error_bounds, std::size_t count);

/// The results for an image, and for its layers if there are any.
struct Verified {
  reference::Verification picture;
  reference::LayerVerification layers;
};

/// The layers of an image, and how they were cut; none: there are no layers.
struct Layers {
  std::span<const scene::Image> images{};
  std::optional<Peel> peel{};
};

/// The largest error of a layer, in linear RGBA: 1e-5, or the promise for the image if that is less.
double layer_bound(const std::optional<double>& promised);

/// Checks `count` pixels of a finished image against the reference: a third at random, the rest from its suspects; the
/// same pixels of its layers.
Verified verify_all(const scene::Image& image, const Layers& layers, const frame::UncutMesh& mesh,
                    const scene::Camera& camera, const scene::TransferFunction& transfer_function,
                    const Settings& settings, std::size_t count);
Verified verify_all(const scene::Image& image, const Layers& layers, const scene::SampleSource& source,
                    const scene::Camera& camera, const scene::TransferFunction& transfer_function,
                    const volume::RenderSettings& settings, std::span<const float> error_bounds, std::size_t count);

/// The same for images without layers.
reference::Verification verify(const scene::Image& image, const frame::UncutMesh& mesh, const scene::Camera& camera,
                               const scene::TransferFunction& transfer_function, const Settings& settings,
                               std::size_t count);
inline reference::Verification verify(const scene::Image& image, const scene::TetMeshView& mesh,
                                      const scene::Camera& camera, const scene::TransferFunction& transfer_function,
                                      const Settings& settings, std::size_t count) {
  return verify(image, frame::UncutMesh{mesh, {}, mesh, nullptr}, camera, transfer_function, settings, count);
}
reference::Verification verify(const scene::Image& image, const scene::SampleSource& source,
                               const scene::Camera& camera, const scene::TransferFunction& transfer_function,
                               const volume::RenderSettings& settings, std::span<const float> error_bounds,
                               std::size_t count);

}  // namespace tessera::api
