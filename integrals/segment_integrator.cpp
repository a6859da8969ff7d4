// SPDX-License-Identifier: BSD-3-Clause
#include "integrals/segment_integrator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scene/error_budget.hpp"

namespace tessera::integrals {

SegmentIntegrator::SegmentIntegrator(const scene::TransferFunction& function, const scene::Integrator& integrator,
                                     scene::Emission emission)
    : table_(function), emission_(emission), termination_error_(1e-7) {
  switch (integrator.kind) {
    case scene::IntegratorKind::exact:
      break;
    case scene::IntegratorKind::sampled:
      samples_ = integrator.samples;
      break;
    case scene::IntegratorKind::preintegrated:
      segments_ = std::make_shared<SegmentTable>(function, emission, integrator.table_size);
      break;
    case scene::IntegratorKind::partial:
      psi_ = std::make_shared<PsiTable>();
      break;
    case scene::IntegratorKind::automatic:
      termination_error_ = scene::error_budget::ended(integrator.accuracy);
      if (emission == scene::Emission::absorption)
        pieces_ = ExactPieces::within(std::min(integrator.accuracy, 4e-2), function.max_color());
      break;
  }
  if (!integrator.terminates) termination_error_ = 0;
}

ExactPieces ExactPieces::within(double accuracy, double max_color) {
  const double brightest = std::max(1.0, max_color);
  ExactPieces pieces;
  for (const auto& [optical_depth, error] : {std::pair{2, 4e-8}, {3, 5e-7}, {4, 3e-6}, {6, 3e-5}})
    if (error <= scene::error_budget::thick_pieces(accuracy) / brightest) pieces.optical_depth = optical_depth;
  pieces.transmittance = std::max(pieces.transmittance, scene::error_budget::dark_pieces(accuracy) / brightest);
  return pieces;
}

void SegmentIntegrator::integrate(SegmentBatch& batch) const {
  if (samples_ > 0)
    integrate_sampled(table_, emission_, samples_, batch);
  else if (segments_)
    integrate_preintegrated(*segments_, emission_, batch);
  else if (psi_)
    integrate_partial(table_, *psi_, batch);
  else
    integrate_exact(table_, emission_, batch, pieces_);
}

std::optional<double> SegmentIntegrator::first_visible(double front, double back) const {
  const auto begin = table_.values.begin(), end = begin + static_cast<std::ptrdiff_t>(table_.knot_count);
  const bool up = back >= front;
  auto interval = static_cast<std::size_t>(
      (up ? std::upper_bound(begin, end, front) : std::lower_bound(begin, end, front)) - begin);
  const auto extinction = [&](double s) {
    return table_.channels[0].start[interval] + table_.channels[0].slope[interval] * (s - table_.base[interval]);
  };
  if (front == back) return extinction(front) > 0 ? std::optional(0.0) : std::nullopt;
  for (double s = front;;) {
    const double target = up ? std::min(table_.above[interval], back) : std::max(table_.below[interval], back);
    if (target != s && (extinction(s) > 0 || extinction(target) > 0)) return (s - front) / (back - front);
    if (target == back) return std::nullopt;
    s = target;
    interval += up ? 1 : std::size_t(-1);
  }
}

std::string SegmentIntegrator::name() const {
  if (samples_ > 0) return fmt::format("sampled:{}", samples_);
  if (segments_) return fmt::format("preintegrated:{}", segments_->size);
  return psi_ ? "partial" : "exact";
}

double opacity_weight(double max_color, double longest_ray, scene::Emission emission) {
  return std::max(1.0, emission == scene::Emission::absorption ? max_color : max_color * longest_ray);
}

}  // namespace tessera::integrals
