#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/transfer_function.hpp"
#include "tessera/surfaces.hpp"

namespace tessera::scene {

using tessera::Surfaces;

/// Throws Error(bad_input) for a value or opacity that is out of range.
void validate(const Surfaces& surfaces);

/// The surfaces of a frame, numbered as projectors and compositors do it.
///
/// Where a ray crosses an iso-surface it makes a crossing, whose number says of which surface it is and which way the
/// field goes: the surfaces' numbers i, ascending by value, where it rises, and 2 n - 1 - i where it falls. Crossings
/// at one depth, in a cell too thin for depths to tell them apart, are then in the ray's order by number.
class SurfaceSet {
 public:
  SurfaceSet() = default;
  /// Of valid surfaces.
  SurfaceSet(const Surfaces& surfaces, const TransferFunction& function);

  [[nodiscard]] bool empty() const { return values_.empty(); }
  /// Of the iso-surfaces, ascending.
  [[nodiscard]] std::span<const double> iso_values() const { return values_; }
  [[nodiscard]] std::uint32_t crossing(std::size_t iso, bool rises) const {
    return static_cast<std::uint32_t>(rises ? iso : 2 * values_.size() - 1 - iso);
  }

  /// What a crossing sends to the eye: linear RGB, premultiplied.
  struct Light {
    double red = 0, green = 0, blue = 0, opacity = 0;
  };
  /// `cosine`: of the angle between ray and normal, 0 to 1. Nothing for a number that is none.
  [[nodiscard]] Light light(std::uint32_t crossing, double cosine) const;
  /// No surface's colour is brighter.
  [[nodiscard]] double max_color() const { return max_color_; }

 private:
  struct Paint {
    glm::dvec3 color;
    double opacity;
  };
  std::vector<double> values_;
  std::vector<Paint> paints_;
  SurfaceLight light_;
  double max_color_ = 0;
};

}  // namespace tessera::scene
