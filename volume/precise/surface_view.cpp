// SPDX-License-Identifier: BSD-3-Clause
#include "volume/precise/surface_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace tessera::volume {

SurfaceView::SurfaceView(const scene::SurfaceSet& surfaces, const LaneSamples& lanes)
    : count(surfaces.iso_values().size()) {
  constexpr std::size_t widest = 16;  // lanes of the longest vectors
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const SurfaceLight& light = surfaces.parts_of_light();
  const scene::SurfaceSet::PaintColumns& paint = surfaces.paint_by_number();
  const std::size_t size = std::max(count + 2, widest);
  for (std::vector<float>* each : {&rest, &exact, &red, &green, &blue, &opacity, &angle_weight})
    each->assign(size, 0.0f);
  edge.assign(size, infinity);
  edge[0] = -infinity;
  const auto number = [](double v) { return static_cast<float>(v); };
  // The derivative of cos^n a is n cos^(n-1) a sin a in magnitude. It is at most about sqrt(n / e), and for small n at
  // most n.
  const double shine_slope = light.specular * std::min(light.shininess, 0.61 * std::sqrt(light.shininess + 1));
  const bool samples_exact = lanes.exact && (!lanes.whole || lanes.whole_numbers);
  value_noise = samples_exact ? 0 : 0x1p-24f;
  for (std::size_t n = 0; n < count; ++n) {
    const double value = surfaces.iso_values()[n];
    // The limits are beyond any sample.
    const double lane = std::clamp((value - lanes.origin) / lanes.unit, -1e30, 1e30);
    const std::uint32_t own = surfaces.crossing(n, true, scene::SurfaceSet::Place::inside);
    const double brightest_channel = std::max({paint.red[own], paint.green[own], paint.blue[own]});
    edge[n + 1] = number(lane), rest[n + 1] = number(lane - static_cast<double>(edge[n + 1]));
    const bool is_exact = samples_exact && lane == edge[n + 1] && lanes.origin + lanes.unit * lane == value;
    exact[n + 1] = is_exact ? 1.0f : 0.0f;
    red[n + 1] = number(paint.red[own]), green[n + 1] = number(paint.green[own]);
    blue[n + 1] = number(paint.blue[own]), opacity[n + 1] = number(paint.opacity[own]);
    angle_weight[n + 1] = number(light.diffuse * brightest_channel + shine_slope);
  }
  // A value that has the same edge as another value is exact only if both values are exact.
  for (std::size_t n = 1; n <= count; ++n)
    for (std::size_t other = 1; other <= count; ++other)
      if (edge[other] == edge[n]) exact[n] = std::min(exact[n], exact[other]);
  any_exact = std::ranges::find(exact, 1.0f) != exact.end();
  ambient = number(light.ambient), diffuse = number(light.diffuse);
  specular = number(light.specular), shininess = number(light.shininess);
  whole_shininess = surfaces.whole_shininess();
}

}  // namespace tessera::volume
