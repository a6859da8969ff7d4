#include "scene/surface_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/error.hpp"

namespace tessera::scene {
namespace {

constexpr std::size_t most_surfaces = 128;  // 768 crossings: ten bits of a mark on the lattice

/// A third of the time of std::pow.
double whole_power(double base, int exponent) {
  double result = 1;
  for (; exponent > 0; exponent /= 2, base *= base)
    if (exponent % 2 != 0) result *= base;
  return result;
}

bool is_light(double value) { return value >= 0 && std::isfinite(value); }

}  // namespace

void validate(const Surfaces& surfaces) {
  if (surfaces.iso.size() > most_surfaces)
    throw bad_input(fmt::format("`iso`: {} surfaces are more than {}", surfaces.iso.size(), most_surfaces));
  for (const IsoSurface& iso : surfaces.iso) {
    if (!std::isfinite(iso.value)) throw bad_input("`iso`: its value is not finite; give a value of the field");
    if (!(iso.opacity > 0 && iso.opacity <= 1))
      throw bad_input(fmt::format("`iso` {}: the opacity {} is not above 0 and at most 1", iso.value, iso.opacity));
    if (iso.color && !(is_light(iso.color->x) && is_light(iso.color->y) && is_light(iso.color->z)))
      throw bad_input(fmt::format("`iso` {}: its colour must be 0 or more, and finite", iso.value));
  }
  const SurfaceLight& light = surfaces.light;
  for (const double part : {light.ambient, light.diffuse, light.specular, light.shininess})
    if (!is_light(part)) throw bad_input("surfaces: the parts of their light must be 0 or more, and finite");
}

SurfaceSet::SurfaceSet(const Surfaces& surfaces, const TransferFunction& function) : light_(surfaces.light) {
  std::vector<std::size_t> order(surfaces.iso.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return surfaces.iso[i].value; });
  for (const std::size_t i : order) {
    const IsoSurface& iso = surfaces.iso[i];
    const glm::dvec3 color = iso.color ? *iso.color : glm::dvec3(function.evaluate(iso.value).color);
    values_.push_back(iso.value);
    paints_.push_back({color, iso.opacity});
    max_color_ = std::max({max_color_, color.x, color.y, color.z});
  }
  const auto n = static_cast<std::uint32_t>(values_.size());
  for (std::uint32_t number = 0; number < 6 * n; ++number)
    paint_of_.push_back(number % (2 * n) < n ? number % n : n - 1 - number % n);
  if (light_.shininess == std::floor(light_.shininess) && light_.shininess <= 1024)
    whole_shininess_ = static_cast<int>(light_.shininess);
  if (!empty()) max_color_ = max_color_ * (light_.ambient + light_.diffuse) + light_.specular;
}

void SurfaceSet::place_on(const Lattice& lattice) {
  on_lattice_.clear();
  for (const double value : values_) on_lattice_.push_back(static_cast<float>(lattice.scalar_step(value)));
  by_number_.clear();
  for (const std::uint32_t i : paint_of_) by_number_.push_back(on_lattice_[i]);
}

SurfaceSet::Light SurfaceSet::light(std::uint32_t crossing, double cosine) const {
  if (crossing >= paint_of_.size()) return {};
  const Paint& paint = paints_[paint_of_[crossing]];
  const double c = std::clamp(cosine, 0.0, 1.0);
  const double matte = light_.ambient + light_.diffuse * c;
  const double shine =
      light_.specular * (whole_shininess_ >= 0 ? whole_power(c, whole_shininess_) : std::pow(c, light_.shininess));
  const glm::dvec3 color = (paint.color * matte + glm::dvec3(shine)) * paint.opacity;
  return {color.x, color.y, color.z, paint.opacity};
}

}  // namespace tessera::scene
