#include "apps/verify.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "reference/reference.hpp"

namespace tessera::apps {

std::optional<double> promised_error(const frame::RenderSettings& settings) {
  if (settings.rasterizer == frame::Rasterizer::scanline || !settings.bounded) return std::nullopt;
  const scene::Integrator& integrator = settings.integrator;
  switch (integrator.kind) {
    case scene::IntegratorKind::exact:
      return 2e-5;
    case scene::IntegratorKind::automatic:
      return integrator.accuracy;
    case scene::IntegratorKind::sampled:
    case scene::IntegratorKind::preintegrated:
    case scene::IntegratorKind::partial:
      break;
  }
  return std::nullopt;
}

bool Verification::met() const {
  if (!std::isfinite(judgement.max_error)) return false;
  return !bound || judgement.passed;
}

Verification verify(const scene::Image& image, const scene::TetMesh& mesh, const scene::Camera& camera,
                    const scene::TransferFunction& transfer_function, const frame::RenderSettings& settings,
                    int count) {
  constexpr std::uint64_t seed = 1;
  const reference::Reference reference(mesh, camera, image.size, transfer_function, settings.emission);
  const auto pixels = reference::random_pixels(image.size, static_cast<std::size_t>(count), seed);
  Verification verification;
  verification.bound = promised_error(settings);
  // Without a bound no pixel is over it, so none is looked at for an excuse.
  const double bound = verification.bound.value_or(std::numeric_limits<double>::infinity());
  verification.judgement = reference::judge(image, reference, bound, pixels, settings.threads);
  return verification;
}

std::string verification_line(const Verification& verification, int frame_number) {
  const auto& judgement = verification.judgement;
  const auto verdict = verification.bound
                           ? fmt::format("bound {:.3g} {}", *verification.bound, verification.met() ? "met" : "NOT met")
                           : std::string("no bound promised");
  return fmt::format("verify frame {}: {} pixels, max {:.3g} rms {:.3g}, worst at ({}, {}), {} excused; {}",
                     frame_number, judgement.pixels_checked, judgement.max_error, judgement.rms_error,
                     judgement.worst_x, judgement.worst_y, judgement.excused, verdict);
}

}  // namespace tessera::apps
