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

/// Throws Error(bad_input) for a value or opacity that is out of range, and for triangles that are none.
void validate(const Surfaces& surfaces);

/// The surfaces of a frame, numbered as projectors and compositors do it.
///
/// Where a ray crosses an iso-surface it makes a crossing, whose number puts crossings at one depth in the ray's order.
/// At one depth there may be some at the back end of one cell's segment and some at the front end of the next one's, as
/// a face may have a surface's value; those of one segment are all crossed upwards or all downwards. Surfaces of
/// triangles, the boundary's and then others, come between: what a ray leaves after the back ends, then what it just
/// goes through, and what it enters before the front ends. So of n iso-surfaces, ascending by value, and m of triangles
/// the number is (2 n + m) Place + k, with k
///   i              for the iso-surface i where the field rises
///   2 n - 1 - i    where it falls
///   2 n + j        for the surface j of triangles, whose Place is inside where the ray enters, else back_end.
class SurfaceSet {
 public:
  SurfaceSet() = default;
  /// Of valid surfaces.
  SurfaceSet(const Surfaces& surfaces, const TransferFunction& function);

  [[nodiscard]] bool empty() const { return paints_.empty(); }
  /// Of the iso-surfaces, ascending.
  [[nodiscard]] std::span<const double> iso_values() const { return values_; }
  /// Where in its segment a crossing is; inside, too, where the segment has no length.
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
  /// Surfaces of triangles: first the boundary's, then the others.
  [[nodiscard]] std::size_t faces() const { return paints_.size() - values_.size(); }
  [[nodiscard]] std::size_t boundaries() const { return boundaries_; }
  [[nodiscard]] std::uint32_t face_crossing(std::size_t surface, bool leaves) const {
    const std::size_t n = values_.size();
    return static_cast<std::uint32_t>((leaves ? 0 : 2 * n + faces()) + 2 * n + surface);
  }

  /// The values in the lattice's steps, as segments' scalars, of which what lies behind a crossing needs one. To be
  /// called before on_lattice(), once the lattice is known.
  void place_on(const Lattice& lattice);
  [[nodiscard]] std::span<const float> on_lattice() const { return on_lattice_; }
  /// The same by the crossing's number.
  [[nodiscard]] std::span<const float> on_lattice_by_number() const { return by_number_; }

  /// What a crossing sends to the eye: linear RGB, premultiplied.
  struct Light {
    double red = 0, green = 0, blue = 0, opacity = 0;
  };
  /// `cosine`: of the angle between ray and normal, 0 to 1. `value`: the field's there, for surfaces of triangles that
  /// have its colour. Nothing for a number that is none.
  [[nodiscard]] Light light(std::uint32_t crossing, double cosine, double value = 0) const;
  /// What light() of iso-surfaces is made of, for lanes: by the crossing's number, and nothing for the one behind the
  /// last.
  struct PaintColumns {
    std::vector<double> red, green, blue, opacity;
  };
  [[nodiscard]] const PaintColumns& paint_by_number() const { return paint_by_number_; }
  [[nodiscard]] const SurfaceLight& parts_of_light() const { return light_; }
  /// The cosine to the power of the light's shininess.
  [[nodiscard]] double shine(double cosine) const;
  /// The same power where it is done by squaring; else -1.
  [[nodiscard]] int whole_shininess() const { return whole_shininess_; }
  /// No surface's colour is brighter.
  [[nodiscard]] double max_color() const { return max_color_; }

 private:
  struct Paint {
    glm::dvec3 color;
    double opacity;
    bool by_field = false;  ///< then `color` is nothing
  };
  void add_face(const std::optional<glm::dvec3>& color, double opacity);
  void fill_columns();

  std::vector<double> values_;
  std::vector<Paint> paints_;  ///< by value, as values_; then of surfaces of triangles
  std::size_t boundaries_ = 0;
  TransferFunction function_;            ///< if a paint is by field
  std::vector<std::uint32_t> paint_of_;  ///< by crossing
  std::vector<float> on_lattice_, by_number_;
  PaintColumns paint_by_number_;
  SurfaceLight light_;
  int whole_shininess_ = -1;  ///< -1: it is no whole number, or a large one
  double max_color_ = 0;
};

}  // namespace tessera::scene
