// SPDX-License-Identifier: BSD-3-Clause
#include "scene/surface_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>

#include "scene/error.hpp"

namespace tessera::scene {
namespace {

constexpr std::size_t most_surfaces = 128;  // gives 768 numbers of crossings, which fit into ten bits on the lattice

/// Computes an integer power, in a third of the time of std::pow.
double whole_power(double base, int exponent) {
  double result = 1;
  for (; exponent > 0; exponent /= 2, base *= base)
    if (exponent % 2 != 0) result *= base;
  return result;
}

const glm::dvec3 light_grey(0.6, 0.6, 0.6);

bool is_light(double value) { return value >= 0 && std::isfinite(value); }

/// Throws for an invalid colour or opacity. `name` is the surface's name in messages.
void check_paint(const std::string& name, const std::optional<glm::dvec3>& color, double opacity) {
  if (!(opacity > 0 && opacity <= 1))
    throw bad_input(fmt::format("{}: the opacity {} is not above 0 and at most 1", name, opacity));
  if (color && !(is_light(color->x) && is_light(color->y) && is_light(color->z)))
    throw bad_input(fmt::format("{}: the components of its colour must be finite and 0 or more", name));
}

void check_triangles(const tessera::TriangleMesh& mesh) {
  const auto finite = [](const glm::dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  if (!std::ranges::all_of(mesh.points, finite))
    throw bad_input("`surface`: a point of its triangles is not finite; correct it");
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle)
      if (v >= mesh.points.size())
        throw bad_input(fmt::format("`surface`: a triangle uses point {}, but there are only {} points; correct it", v,
                                    mesh.points.size()));
  if (!mesh.values.empty() && mesh.values.size() != mesh.points.size())
    throw bad_input(fmt::format("`surface`: it has {} values for {} points; give one value per point, or none",
                                mesh.values.size(), mesh.points.size()));
  if (!std::ranges::all_of(mesh.values, [](double v) { return std::isfinite(v); }))
    throw bad_input("`surface`: a value at its points is not finite; correct it, or leave the values out");
}

}  // namespace

void validate(const Surfaces& surfaces) {
  if (surfaces.iso.size() > most_surfaces)
    throw bad_input(fmt::format("`iso`: {} surfaces are more than {}", surfaces.iso.size(), most_surfaces));
  if (surfaces.boundary.size() + surfaces.triangles.size() > most_surfaces)
    throw bad_input(fmt::format("`surface`: {} surfaces are more than {}",
                                surfaces.boundary.size() + surfaces.triangles.size(), most_surfaces));
  for (const IsoSurface& iso : surfaces.iso) {
    if (!std::isfinite(iso.value)) throw bad_input("`iso`: its value is not finite; give a value of the field");
    check_paint(fmt::format("`iso` {}", iso.value), iso.color, iso.opacity);
  }
  for (const BoundarySurface& boundary : surfaces.boundary)
    check_paint("`surface` boundary", boundary.color, boundary.opacity);
  for (const TriangleSurface& surface : surfaces.triangles) {
    if (surface.mesh == nullptr) throw bad_input("`surface`: it has no triangles; give it triangles, or leave it out");
    check_paint("`surface`", surface.color, surface.opacity);
    check_triangles(*surface.mesh);
  }
  const SurfaceLight& light = surfaces.light;
  for (const double part : {light.ambient, light.diffuse, light.specular, light.shininess})
    if (!is_light(part)) throw bad_input("surfaces: the components of their lighting must be finite and 0 or more");
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
  if (surfaces.has_faces()) function_ = function;
  boundaries_ = surfaces.boundary.size();
  for (const BoundarySurface& boundary : surfaces.boundary) add_face(boundary.color, boundary.opacity);
  for (const TriangleSurface& surface : surfaces.triangles) {
    const bool by_field = !surface.color && !surface.mesh->values.empty();
    add_face(by_field ? std::nullopt : std::optional(surface.color.value_or(light_grey)), surface.opacity);
  }
  const auto n = static_cast<std::uint32_t>(values_.size()), m = static_cast<std::uint32_t>(faces());
  for (std::uint32_t number = 0; number < 3 * (2 * n + m); ++number) {
    const std::uint32_t k = number % (2 * n + m);
    paint_of_.push_back(k < n ? k : k < 2 * n ? 2 * n - 1 - k : k - n);
  }
  fill_columns();
  if (light_.shininess == std::floor(light_.shininess) && light_.shininess <= 1024)
    whole_shininess_ = static_cast<int>(light_.shininess);
  if (!empty()) max_color_ = max_color_ * (light_.ambient + light_.diffuse) + light_.specular;
}

void SurfaceSet::add_face(const std::optional<glm::dvec3>& color, double opacity) {
  paints_.push_back({color.value_or(glm::dvec3(0)), opacity, !color});
  max_color_ = std::max(max_color_, color ? std::max({color->x, color->y, color->z}) : function_.max_color());
}

void SurfaceSet::fill_columns() {
  PaintColumns& to = paint_by_number_;
  const auto add = [&](const Paint& paint) {
    to.red.push_back(paint.color.x), to.green.push_back(paint.color.y), to.blue.push_back(paint.color.z);
    to.opacity.push_back(paint.opacity), to.by_field.push_back(paint.by_field ? 1 : 0);
    shows_field_ = shows_field_ || paint.by_field;
  };
  for (const std::uint32_t i : paint_of_) add(paints_[i]);
  add({glm::dvec3(0), 0});
}

double SurfaceSet::shine(double cosine) const {
  return whole_shininess_ >= 0 ? whole_power(cosine, whole_shininess_) : std::pow(cosine, light_.shininess);
}

void SurfaceSet::place_on(const Lattice& lattice) {
  on_lattice_.clear();
  for (const double value : values_) on_lattice_.push_back(static_cast<float>(lattice.scalar_step(value)));
  by_number_.clear();
  for (const std::uint32_t i : paint_of_) by_number_.push_back(i < on_lattice_.size() ? on_lattice_[i] : 0.0f);
}

SurfaceSet::Light SurfaceSet::light(std::uint32_t crossing, double cosine, double value) const {
  if (crossing >= paint_of_.size()) return {};
  const Paint& paint = paints_[paint_of_[crossing]];
  const double c = std::clamp(cosine, 0.0, 1.0);
  const double matte = light_.ambient + light_.diffuse * c;
  const double bright = light_.specular * shine(c);
  const glm::dvec3 own = paint.by_field ? glm::dvec3(function_.evaluate(value).color) : paint.color;
  const glm::dvec3 color = (own * matte + glm::dvec3(bright)) * paint.opacity;
  return {color.x, color.y, color.z, paint.opacity};
}

}  // namespace tessera::scene
