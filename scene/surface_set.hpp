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
/// A crossing is a point where a ray meets a surface. Its number sorts crossings at the same depth into the order along
/// the ray. If a face has the value of an iso-surface, there may be crossings at the same depth at the back end of one
/// cell's segment and at the front end of the next cell's segment. In one segment, the field either rises at all
/// crossings of iso-surfaces or falls at all of them. Triangle surfaces (first the boundary, then others) are between
/// the back ends and the front ends: first those that the ray leaves, then those that it crosses, then those that it
/// enters. For n iso-surfaces, ascending by value, and m triangle surfaces, the number is therefore (2 n + m) Place +
/// k, with k
///   i              for the iso-surface i where the field rises
///   2 n - 1 - i    where it falls
///   2 n + j        for the triangle surface j; Place is `inside` where the ray enters, otherwise `back_end`.
class SurfaceSet {
 public:
  SurfaceSet() = default;
  /// The surfaces must be valid.
  SurfaceSet(const Surfaces& surfaces, const TransferFunction& function);

  [[nodiscard]] bool empty() const { return paints_.empty(); }
  /// Values of the iso-surfaces, ascending.
  [[nodiscard]] std::span<const double> iso_values() const { return values_; }
  /// The place of a crossing in its segment; `inside` also for a segment without length.
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

  /// Converts the values to lattice steps, which are the scalars where a segment is cut at a crossing. Must be called
  /// after the lattice is known and before on_lattice().
  void place_on(const Lattice& lattice);
  [[nodiscard]] std::span<const float> on_lattice() const { return on_lattice_; }
  /// The same values, indexed by the number of the crossing.
  [[nodiscard]] std::span<const float> on_lattice_by_number() const { return by_number_; }

  /// The light of a crossing towards the eye: linear RGB, premultiplied.
  struct Light {
    double red = 0, green = 0, blue = 0, opacity = 0;
  };
  /// Returns the light of a crossing. `cosine` is the cosine of the angle between ray and normal, 0 to 1. `value` is
  /// the field's value at the crossing, for triangle surfaces coloured by the field. The light is zero if no crossing
  /// has the number `crossing`.
  [[nodiscard]] Light light(std::uint32_t crossing, double cosine, double value = 0) const;
  /// The components of light() for vector code, indexed by the number of the crossing, with zeros after the last
  /// crossing. For surfaces that have the colour of the field, `by_field` is 1 and red, green and blue are 0; for all
  /// others, `by_field` is 0.
  struct PaintColumns {
    std::vector<double> red, green, blue, opacity, by_field;
  };
  [[nodiscard]] const PaintColumns& paint_by_number() const { return paint_by_number_; }
  /// Whether some surface has the colour of the field.
  [[nodiscard]] bool shows_field() const { return shows_field_; }
  [[nodiscard]] const SurfaceLight& parts_of_light() const { return light_; }
  /// Returns `cosine` to the power of the light's shininess.
  [[nodiscard]] double shine(double cosine) const;
  /// The shininess if shine() computes the power by repeated squaring; otherwise -1.
  [[nodiscard]] int whole_shininess() const { return whole_shininess_; }
  /// Upper bound of the colours of all surfaces.
  [[nodiscard]] double max_color() const { return max_color_; }

 private:
  struct Paint {
    glm::dvec3 color;
    double opacity;
    bool by_field = false;  ///< true: the surface has the colour of the field, and `color` is unused
  };
  void add_face(const std::optional<glm::dvec3>& color, double opacity);
  void fill_columns();

  std::vector<double> values_;
  std::vector<Paint> paints_;  ///< paints of the iso-surfaces, in the order of values_; then those of the triangle
                               ///< surfaces
  std::size_t boundaries_ = 0;
  TransferFunction function_;            ///< used if the colour of a surface is that of the field
  std::vector<std::uint32_t> paint_of_;  ///< index of the paint, by number of the crossing
  std::vector<float> on_lattice_, by_number_;
  PaintColumns paint_by_number_;
  SurfaceLight light_;
  bool shows_field_ = false;
  int whole_shininess_ = -1;  ///< -1: not an integer, or a large one
  double max_color_ = 0;
};

}  // namespace tessera::scene
