#include "volume/surface_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::volume {

SurfaceView::SurfaceView(const Surfaces& surfaces, const scene::TransferFunction& function, const LaneSamples& lanes)
    : count(surfaces.iso.size()) {
  constexpr std::size_t widest = 16;  // lanes
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const SurfaceLight& light = surfaces.light;
  std::vector<IsoSurface> ascending = surfaces.iso;
  std::ranges::stable_sort(ascending, {}, &IsoSurface::value);
  const std::size_t size = std::max(count + 2, widest);
  for (std::vector<float>* each : {&rest, &exact, &red, &green, &blue, &opacity, &angle_weight})
    each->assign(size, 0.0f);
  edge.assign(size, infinity);
  edge[0] = -infinity;
  const auto number = [](double v) { return static_cast<float>(v); };
  // Of the angle a, cos^n changes by n cos^(n-1) sin, at most the root of n / e, and of n where that is less than one.
  const double shine_slope = light.specular * std::min(light.shininess, 0.61 * std::sqrt(light.shininess + 1));
  const bool samples_exact = lanes.exact && (!lanes.whole || lanes.whole_numbers);
  value_noise = samples_exact ? 0 : 0x1p-24f;
  for (std::size_t n = 0; n < count; ++n) {
    const IsoSurface& iso = ascending[n];
    // Beyond any sample.
    const double lane = std::clamp((iso.value - lanes.origin) / lanes.unit, -1e30, 1e30);
    const glm::dvec3 color = iso.color ? *iso.color : glm::dvec3(function.evaluate(iso.value).color);
    edge[n + 1] = number(lane), rest[n + 1] = number(lane - static_cast<double>(edge[n + 1]));
    const bool is_exact = samples_exact && lane == edge[n + 1] && lanes.origin + lanes.unit * lane == iso.value;
    exact[n + 1] = is_exact ? 1.0f : 0.0f;
    red[n + 1] = number(color.x), green[n + 1] = number(color.y), blue[n + 1] = number(color.z);
    opacity[n + 1] = number(iso.opacity);
    angle_weight[n + 1] = number(light.diffuse * std::max({color.x, color.y, color.z}) + shine_slope);
  }
  // Nor is a value that lanes do not tell from another one that is not.
  for (std::size_t n = 1; n <= count; ++n)
    for (std::size_t other = 1; other <= count; ++other)
      if (edge[other] == edge[n]) exact[n] = std::min(exact[n], exact[other]);
  any_exact = std::ranges::find(exact, 1.0f) != exact.end();
  ambient = number(light.ambient), diffuse = number(light.diffuse);
  specular = number(light.specular), shininess = number(light.shininess);
  if (light.shininess == std::floor(light.shininess) && light.shininess <= 1024)
    whole_shininess = static_cast<int>(light.shininess);
}

}  // namespace tessera::volume
