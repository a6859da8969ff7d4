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
/// `automatic` the requested accuracy. None for other integrators, for the scanline rasterizer, and for compositing as
/// published (gl-fragment): their errors are only reported.
std::optional<double> promised_error(const Settings& settings, DataKind data);

/// Chooses the suspicious pixels of a finished image for a check of `count` pixels: those that are least certain
/// according to the image, the scene and the frame's own estimates (reference/suspicion.hpp). The result depends only
/// on the arguments and not on the number of threads, so that a second run, on any number of ranks, checks the same
/// pixels.
reference::Suspects suspects(const scene::Image& image, const scene::TetMeshView& mesh, const scene::Camera& camera,
                             const scene::TransferFunction& transfer_function, const Settings& settings,
                             std::size_t count);

/// `error_bounds` contains a bound for each pixel, from volume::Renderer::render(); it may be empty.
reference::Suspects suspects(const scene::Image& image, const scene::SampleSource& source, const scene::Camera& camera,
                             const scene::TransferFunction& transfer_function, const volume::RenderSettings& settings,
                             std::span<const float> error_bounds, std::size_t count);

/// The results for an image, and for its layers if there are any.
struct Verified {
  reference::Verification picture;
  reference::LayerVerification layers;
};

/// The layers of an image, and the settings with which they were separated; empty if there are no layers.
struct Layers {
  std::span<const scene::Image> images{};
  std::optional<Peel> peel{};
};

/// The largest promised error of a layer, in linear RGBA: 1e-5 or, if it is smaller, the promised error of the image.
double layer_bound(const std::optional<double>& promised);

/// Checks `count` pixels of a finished image against the reference: a third of them random, the others suspicious. The
/// same pixels of the layers are checked.
Verified verify_all(const scene::Image& image, const Layers& layers, const frame::UncutMesh& mesh,
                    const scene::Camera& camera, const scene::TransferFunction& transfer_function,
                    const Settings& settings, std::size_t count);
Verified verify_all(const scene::Image& image, const Layers& layers, const scene::SampleSource& source,
                    const scene::Camera& camera, const scene::TransferFunction& transfer_function,
                    const volume::RenderSettings& settings, std::span<const float> error_bounds, std::size_t count);

/// Does the same for an image without layers.
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
