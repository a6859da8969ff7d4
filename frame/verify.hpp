#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "frame/render.hpp"
#include "frame/uncut_mesh.hpp"
#include "reference/verification.hpp"
#include "scene/camera.hpp"
#include "scene/image.hpp"
#include "scene/sample_source.hpp"
#include "scene/tet_mesh.hpp"
#include "scene/transfer_function.hpp"
#include "volume/render.hpp"

namespace tessera::frame {

/// The largest error that is promised, in linear RGBA: 2e-5 for exact, what was asked for automatic, none for sampled,
/// preintegrated and partial, with the scanline rasterizer, or composited as printed (gl-fragment): there the error is
/// only reported.
std::optional<double> promised_error(const RenderSettings& settings);

/// Of volumes: 1e-5 for exact, what was asked for automatic, none where steps decide it.
std::optional<double> promised_error(const volume::RenderSettings& settings);

/// Where a finished picture is to be looked at when `count` of its pixels are judged: where the picture itself, the
/// scene and the frame's own estimates make it least sure (reference/suspicion.hpp). Depends on the arguments alone,
/// `threads` excepted, so that a second run, on any number of ranks, looks at the same pixels.
reference::Suspects suspects(const scene::Image& image, const scene::TetMeshView& mesh, const scene::Camera& camera,
                             const scene::TransferFunction& transfer_function, const RenderSettings& settings,
                             std::size_t count);

/// `error_bounds`: by pixel, of volume::Renderer::render; empty if there are none.
reference::Suspects suspects(const scene::Image& image, const scene::SampleSource& source, const scene::Camera& camera,
                             const scene::TransferFunction& transfer_function, const volume::RenderSettings& settings,
                             std::span<const float> error_bounds, std::size_t count);

/// Checks `count` pixels of a finished picture against the reference: a third at random, the rest of its suspects.
reference::Verification verify(const scene::Image& image, const UncutMesh& mesh, const scene::Camera& camera,
                               const scene::TransferFunction& transfer_function, const RenderSettings& settings,
                               std::size_t count);
inline reference::Verification verify(const scene::Image& image, const scene::TetMeshView& mesh,
                                      const scene::Camera& camera, const scene::TransferFunction& transfer_function,
                                      const RenderSettings& settings, std::size_t count) {
  return verify(image, UncutMesh{mesh, {}, mesh, nullptr}, camera, transfer_function, settings, count);
}
reference::Verification verify(const scene::Image& image, const scene::SampleSource& source,
                               const scene::Camera& camera, const scene::TransferFunction& transfer_function,
                               const volume::RenderSettings& settings, std::span<const float> error_bounds,
                               std::size_t count);

}  // namespace tessera::frame
