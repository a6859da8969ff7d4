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

/// The largest error that is promised, in linear RGBA: for exact 2e-5 of meshes and 1e-5 of grids, what was asked for
/// automatic. None for methods that take steps or samples, with the scanline rasterizer, or composited as printed
/// (gl-fragment): there the error is only reported.
std::optional<double> promised_error(const Settings& settings, DataKind data);

/// Where a finished picture is to be looked at when `count` of its pixels are judged: where the picture itself, the
/// scene and the frame's own estimates make it least sure (reference/suspicion.hpp). Depends on the arguments alone,
/// `threads` excepted, so that a second run, on any number of ranks, looks at the same pixels.
reference::Suspects suspects(const scene::Image& image, const scene::TetMeshView& mesh, const scene::Camera& camera,
                             const scene::TransferFunction& transfer_function, const Settings& settings,
                             std::size_t count);

/// `error_bounds`: by pixel, of volume::Renderer::render; empty if there are none.
reference::Suspects suspects(const scene::Image& image, const scene::SampleSource& source, const scene::Camera& camera,
                             const scene::TransferFunction& transfer_function, const volume::RenderSettings& settings,
                             std::span<const float> error_bounds, std::size_t count);

/// What is found of a picture, and of its layers if there are any.
struct Verified {
  reference::Verification picture;
  reference::LayerVerification layers;
};

/// The layers of a picture, and how they were cut; none: there are none.
struct Layers {
  std::span<const scene::Image> images{};
  std::optional<Peel> peel{};
};

/// The largest error of a layer, in linear RGBA: 1e-5, or the picture's promise if that is less.
double layer_bound(const std::optional<double>& promised);

/// Checks `count` pixels of a finished picture against the reference: a third at random, the rest of its suspects; of
/// its layers the same ones.
Verified verify_all(const scene::Image& image, const Layers& layers, const frame::UncutMesh& mesh,
                    const scene::Camera& camera, const scene::TransferFunction& transfer_function,
                    const Settings& settings, std::size_t count);
Verified verify_all(const scene::Image& image, const Layers& layers, const scene::SampleSource& source,
                    const scene::Camera& camera, const scene::TransferFunction& transfer_function,
                    const volume::RenderSettings& settings, std::span<const float> error_bounds, std::size_t count);

/// The same of pictures without layers.
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
