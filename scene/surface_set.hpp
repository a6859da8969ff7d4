// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/lattice.hpp"
#include "scene/transfer_function.hpp"
#include "tessera/surfaces.hpp"

namespace tessera::scene {

using tessera::Surfaces;

/// Throws Error(bad_input) for a value or opacity that is out of range, and for invalid triangles.
void validate(const Surfaces& surfaces);

/// The surfaces of a frame, with the numbering shared by projectors and compositors.
///
/// A ray crossing an iso-surface makes a crossing, whose number sorts crossings at one depth in the ray's order. At one
/// depth there may be crossings at the back end of one cell's segment and at the front end of the next one's, as a face
/// may have a surface's value; those of one segment are all crossed upwards or all downwards. Triangle surfaces, first
/// the boundary, then others, come between: first those that the ray leaves, after the back ends, then those that it
/// crosses, then those that it enters, before the front ends. So for n iso-surfaces, ascending by value, and m triangle
/// surfaces the number is (2 n + m) Place + k, with k
///   i              for the iso-surface i where the field rises
///   2 n - 1 - i    where it falls
///   2 n + j        for the triangle surface j, whose Place is inside where the ray enters, else back_end.
class SurfaceSet {
 public:
  SurfaceSet() = default;
  /// The surfaces must be valid.
  SurfaceSet(const Surfaces& surfaces, const TransferFunction& function);

  [[nodiscard]] bool empty() const { return paints_.empty(); }
  /// Values of the iso-surfaces, ascending.
  [[nodiscard]] std::span<const double> iso_values() const { return values_; }
  /// Where in its segment a crossing is; also inside if the segment has no length.
  enum class Place : std::uint8_t { back_end, inside, front_end };
  template <class Depth>
  [[nodiscard]] static Place place_of(Depth depth, Depth front, Depth back) {
    if (!(front < back)) return Place::inside;
    return depth == back ? Place::back_end : depth == front ? Place::front_end : Place::inside;
  }
  [[nodiscard]] std::uint32_t crossing(std::size_t iso, bool rises, Place place) const {
    const std::size_t n = values_.size();
    return static_cast<std::uint32_t>((2 * n + faces()) * static_cast<std::size_t>(place) +
                                      (rises ? iso : 2 * n - 1 - iso));
  }
  /// Number of triangle surfaces: first the boundary, then the others.
  [[nodiscard]] std::size_t faces() const { return paints_.size() - values_.size(); }
  [[nodiscard]] std::size_t boundaries() const { return boundaries_; }
  [[nodiscard]] std::uint32_t face_crossing(std::size_t surface, bool leaves) const {
    const std::size_t n = values_.size();
    return static_cast<std::uint32_t>((leaves ? 0 : 2 * n + faces()) + 2 * n + surface);
  }

  /// Converts the values to lattice steps, which the part of a segment behind a crossing needs as its scalar. Call it
  /// before on_lattice(), once the lattice is known.
  void place_on(const Lattice& lattice);
  [[nodiscard]] std::span<const float> on_lattice() const { return on_lattice_; }
  /// The same, by the number of the crossing.
  [[nodiscard]] std::span<const float> on_lattice_by_number() const { return by_number_; }

  /// The light of a crossing towards the eye: linear RGB, premultiplied.
  struct Light {
    double red = 0, green = 0, blue = 0, opacity = 0;
  };
  /// `cosine`: of the angle between ray and normal, 0 to 1. `value`: the field's value there, for triangle surfaces
  /// coloured by it. Zero for a number without a crossing.
  [[nodiscard]] Light light(std::uint32_t crossing, double cosine, double value = 0) const;
  /// The components of light() of iso-surfaces, for lanes: by the number of the crossing, with zeros after the last.
  struct PaintColumns {
    std::vector<double> red, green, blue, opacity;
  };
  [[nodiscard]] const PaintColumns& paint_by_number() const { return paint_by_number_; }
  [[nodiscard]] const SurfaceLight& parts_of_light() const { return light_; }
  /// The cosine to the power of the light's shininess.
  [[nodiscard]] double shine(double cosine) const;
  /// The exponent if the power is computed by squaring; otherwise -1.
  [[nodiscard]] int whole_shininess() const { return whole_shininess_; }
  /// Upper bound of the colours of all surfaces.
  [[nodiscard]] double max_color() const { return max_color_; }

 private:
  struct Paint {
    glm::dvec3 color;
    double opacity;
    bool by_field = false;  ///< then `color` is unused
  };
  void add_face(const std::optional<glm::dvec3>& color, double opacity);
  void fill_columns();

  std::vector<double> values_;
  std::vector<Paint> paints_;  ///< by value, as values_; then those of triangle surfaces
  std::size_t boundaries_ = 0;
  TransferFunction function_;            ///< if the colour of a surface is that of the field
  std::vector<std::uint32_t> paint_of_;  ///< by crossing
  std::vector<float> on_lattice_, by_number_;
  PaintColumns paint_by_number_;
  SurfaceLight light_;
  int whole_shininess_ = -1;  ///< -1: not an integer, or a large one
  double max_color_ = 0;
};

}  // namespace tessera::scene
