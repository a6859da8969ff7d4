// SPDX-License-Identifier: BSD-3-Clause
#include "integrals/ray_layers.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tessera::integrals {
namespace {

constexpr double rounding = 1e-12;  // relative rounding error of a layer's optical depth

scene::Integrator exact(bool terminates) {
  scene::Integrator integrator;
  integrator.kind = scene::IntegratorKind::exact;
  integrator.terminates = terminates;
  return integrator;
}

}  // namespace

RayLayers::RayLayers(const scene::TransferFunction& function, scene::Emission emission, const Peel& peel,
                     bool terminates)
    : table_(function),
      integrator_(function, exact(terminates), emission),
      independent_(emission == scene::Emission::independent),
      limit_(-std::log1p(-peel.threshold)),
      enough_(limit_ * (1 - rounding)),
      layers_(peel.layers) {}

/// Calls visit(u0, u1, extinction_0, extinction_1), front to back, for each piece of a stretch between knots of the
/// transfer function, with positions from 0 to 1 along the stretch, until `visit` returns false.
template <class Visit>
void RayLayers::visit_pieces(const Stretch& stretch, const Visit& visit) const {
  const double s0 = stretch.scalar_front, s1 = stretch.scalar_back;
  const auto begin = table_.values.begin(), end = begin + static_cast<std::ptrdiff_t>(table_.knot_count);
  const bool up = s1 >= s0;
  auto interval =
      static_cast<std::size_t>((up ? std::upper_bound(begin, end, s0) : std::lower_bound(begin, end, s0)) - begin);
  const auto extinction = [&](double s) {
    return table_.channels[0].start[interval] + table_.channels[0].slope[interval] * (s - table_.base[interval]);
  };
  if (s0 == s1) {
    visit(0.0, 1.0, extinction(s0), extinction(s0));
    return;
  }
  for (double s = s0, u = 0; u < 1;) {
    const double target = up ? std::min(table_.above[interval], s1) : std::max(table_.below[interval], s1);
    const double next = target == s1 ? 1 : std::clamp((target - s0) / (s1 - s0), u, 1.0);
    if (next > u && !visit(u, next, extinction(s), extinction(target))) return;
    u = next, s = target;
    if (target != s1) interval += up ? 1 : std::size_t(-1);
  }
}

void RayLayers::find_cuts(const Stretch& stretch, const OpenLayer& layer) {
  cuts_.clear();
  double held = layer.optical_depth;
  int left = layers_ - 1 - layer.number;
  visit_pieces(stretch, [&](double u0, double u1, double k0, double k1) {
    const double length = stretch.length * (u1 - u0), rise = k1 - k0;
    for (double x = 0; left > 0;) {
      const double rest = length * (1 - x) * (k0 + rise * (1 + x) / 2);
      if (!is_full(held + rest)) {
        held += rest;
        return true;
      }
      // The solution of length (k d + rise d^2 / 2) = limit - held, in the form without cancellation.
      const double k = k0 + rise * x, q = std::max(0.0, limit_ - held) / length;
      const double d = 2 * q / (k + std::sqrt(std::max(0.0, k * k + 2 * rise * q)));
      x = x + d < 1 ? x + d : 1;
      cuts_.push_back(x < 1 ? u0 + (u1 - u0) * x : u1);
      held = 0;
      --left;
    }
    return false;
  });
}

void RayLayers::add(const Stretch& stretch, const SegmentBatch& batch, std::size_t k, OpenLayer& layer,
                    std::vector<RayLayer>& ended) {
  constexpr double margin = 1e-9;  // exceeds the relative error of the integrator's optical depth
  const double least = layer.optical_depth + batch.optical_depth[k] * (1 + margin);
  cuts_.clear();
  if (!is_last(layer) && least >= limit_ * (1 - margin)) find_cuts(stretch, layer);
  if (cuts_.empty()) return append(stretch, batch, k, layer);
  const double s0 = stretch.scalar_front, s1 = stretch.scalar_back;
  const std::size_t parts = cuts_.size() + 1;
  const auto cut = [&](std::size_t i) { return i == 0 ? 0 : i == parts ? 1 : cuts_[i - 1]; };
  const auto at = [](double a, double b, double u) { return u == 1 ? b : a + (b - a) * u; };
  parts_.reserve(parts);
  parts_.size = parts;
  for (std::size_t i = 0; i < parts; ++i) {
    parts_.length[i] = stretch.length * (cut(i + 1) - cut(i));
    parts_.scalar_front[i] = at(s0, s1, cut(i)), parts_.scalar_back[i] = at(s0, s1, cut(i + 1));
    // If rounding makes both scalars of a part equal, the part could be placed on a step that the stretch does not
    // reach.
    if (parts_.scalar_front[i] == parts_.scalar_back[i]) parts_.scalar_front[i] = s0, parts_.scalar_back[i] = s1;
  }
  integrator_.integrate(parts_);
  for (std::size_t i = 0; i < parts; ++i) {
    Stretch part = stretch;
    part.front = at(stretch.front, stretch.back, cut(i)), part.back = at(stretch.front, stretch.back, cut(i + 1));
    part.scalar_front = parts_.scalar_front[i], part.scalar_back = parts_.scalar_back[i];
    append(part, parts_, i, layer);
    if (i + 1 == parts) break;
    const int number = layer.number;
    end(layer, ended);
    layer.number = number + 1;
  }
}

void RayLayers::append(const Stretch& stretch, const SegmentBatch& batch, std::size_t k, OpenLayer& layer) const {
  const double optical_depth = batch.optical_depth[k];
  const double white = stretch.white > 0 ? -stretch.white * std::expm1(-optical_depth) : 0;
  const double red = stretch.own * batch.red[k] + white, green = stretch.own * batch.green[k] + white,
               blue = stretch.own * batch.blue[k] + white;
  if (!(optical_depth > 0 || red > 0 || green > 0 || blue > 0)) return;
  if (std::isinf(layer.front)) {
    const double begins =
        independent_ ? 0 : integrator_.first_visible(stretch.scalar_front, stretch.scalar_back).value_or(0);
    layer.front = stretch.front + (stretch.back - stretch.front) * begins;
  }
  layer.last_front = stretch.front, layer.last_back = stretch.back;
  layer.last_scalar_front = stretch.scalar_front, layer.last_scalar_back = stretch.scalar_back;
  layer.red += layer.transmittance * red;
  layer.green += layer.transmittance * green;
  layer.blue += layer.transmittance * blue;
  layer.optical_depth += optical_depth;
  layer.transmittance *= batch.transmittance[k];
}

void RayLayers::add_surface(double depth, const scene::SurfaceSet::Light& light, OpenLayer& layer,
                            std::vector<RayLayer>& ended) const {
  if (!(light.opacity > 0)) return;
  if (std::isinf(layer.front)) layer.front = depth;
  layer.last_front = layer.last_back = depth;
  layer.red += layer.transmittance * light.red;
  layer.green += layer.transmittance * light.green;
  layer.blue += layer.transmittance * light.blue;
  layer.optical_depth -= std::log1p(-light.opacity);  // infinite where the surface is opaque
  layer.transmittance *= 1 - light.opacity;
  if (is_last(layer) || !is_full(layer.optical_depth)) return;
  const int number = layer.number;
  end(layer, ended);
  layer.number = number + 1;
}

void RayLayers::end(OpenLayer& layer, std::vector<RayLayer>& ended) const {
  if (std::isfinite(layer.front)) {
    double back = layer.last_back;
    if (!independent_ && layer.last_front < back) {
      const double clear = integrator_.first_visible(layer.last_scalar_back, layer.last_scalar_front).value_or(0);
      back -= (layer.last_back - layer.last_front) * clear;
    }
    ended.push_back(
        {layer.front, std::max(layer.front, back), layer.red, layer.green, layer.blue, layer.optical_depth});
  }
  layer = {};
}

}  // namespace tessera::integrals
