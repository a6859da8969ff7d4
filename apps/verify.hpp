#pragma once

#include <optional>
#include <string>

#include "frame/render.hpp"
#include "reference/judge.hpp"
#include "scene/image.hpp"
#include "scene/optical_model.hpp"
#include "scene/tet_mesh.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::apps {

/// The largest error that is promised, in linear RGBA: 2e-5 for exact, what was asked for automatic, none for sampled,
/// preintegrated and partial, with the scanline rasterizer, or composited as printed (gl-fragment): there the error is
/// only reported.
std::optional<double> promised_error(const frame::RenderSettings& settings);

struct Verification {
  reference::Judgement judgement;
  std::optional<double> bound;
  [[nodiscard]] bool met() const;
};

/// Checks `count` pixels of an image against the reference. The choice of pixels depends on the image's size alone, so
/// that a second run checks the same ones. `threads` 0: all cores.
Verification verify(const scene::Image& image, const scene::TetMesh& mesh, const scene::Camera& camera,
                    const scene::TransferFunction& transfer_function, const frame::RenderSettings& settings, int count);

/// `verify frame 3: 1000 pixels, max 1.2e-06 rms 2.1e-08, worst at (512, 33), 0 excused; bound 2e-05 met`
std::string verification_line(const Verification& verification, int frame_number);

}  // namespace tessera::apps
