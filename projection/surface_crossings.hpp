// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "projection/lattice/segment_windows.hpp"
#include "projection/pixel_space.hpp"
#include "projection/prepared_mesh.hpp"
#include "scene/lattice.hpp"
#include "scene/surface_set.hpp"

/// Crossings of rays with iso-surfaces. A crossing is stored among the ray segments; stores, sorting and messages treat
/// it like a segment. The cell's own segment is cut at the crossing, so that in depth order the crossing is between the
/// parts of the segment.
namespace tessera::projection {

/// The number of a crossing (scene::SurfaceSet), and the cosine of the angle between ray and normal.
struct Crossing {
  std::uint32_t number;
  float cosine;
};

/// In double precision, a crossing is a segment of length zero whose front scalar is NaN; the lower bits of the NaN
/// contain the crossing.
inline double marked(const Crossing& crossing) {
  constexpr std::uint64_t no_number = 0x7ff8ull << 48;
  return std::bit_cast<double>(no_number | static_cast<std::uint64_t>(crossing.number) << 32 |
                               std::bit_cast<std::uint32_t>(crossing.cosine));
}
inline bool is_crossing(double scalar_front) { return std::isnan(scalar_front); }
inline Crossing crossing_of(double scalar_front) {
  const auto bits = std::bit_cast<std::uint64_t>(scalar_front);
  return {static_cast<std::uint32_t>(bits >> 32 & 0xffff), std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
}

/// On the lattice, a crossing is the front end of a segment; the surface is in front of the segment's matter. The front
/// scalar, which would be the surface's value, is replaced by a mark: a number beyond all values of the field, four
/// times as far as the lattice extends. Marks have the same order as the crossings' numbers, with the cosine in the
/// lower bits. A crossing at the back end of a cell's segment is a separate segment of length zero.
struct LatticeMark {
  static constexpr float first = 0x1p32f;
  static constexpr std::uint32_t first_bits = 0x4f800000, cosine_bits = 19, cosines = (1u << cosine_bits) - 1;
  static_assert(std::bit_cast<std::uint32_t>(first) == first_bits);

  static std::uint32_t cosine_code(float cosine) {
    return static_cast<std::uint32_t>(std::floor(cosine * cosines + 0.5f));
  }
  static float of(const Crossing& crossing) {
    return std::bit_cast<float>(first_bits + (crossing.number << cosine_bits | cosine_code(crossing.cosine)));
  }
};
inline bool is_crossing(float scalar_front) { return scalar_front >= LatticeMark::first; }
inline Crossing crossing_of(float scalar_front) {
  const std::uint32_t code = std::bit_cast<std::uint32_t>(scalar_front) - LatticeMark::first_bits;
  return {code >> LatticeMark::cosine_bits,
          static_cast<float>(code & LatticeMark::cosines) / static_cast<float>(LatticeMark::cosines)};
}

/// The position of a segment's crossing on the lattice. Depths of a common face differ by some steps between a cell in
/// double precision and a cell on the lattice. A crossing close to the back end is therefore moved `back_end_steps` in
/// front of the back end, so that it is in front of the next cell's entire segment.
constexpr std::int32_t back_end_steps = 32;
struct LatticePlace {
  std::int32_t depth;
  scene::SurfaceSet::Place place;

  static LatticePlace of(std::int32_t depth, std::int32_t front, std::int32_t back) {
    using Place = scene::SurfaceSet::Place;
    const std::int32_t limit = std::max(front, back - back_end_steps);
    if (depth >= limit) return {limit, limit > front ? Place::back_end : Place::inside};
    return {depth, depth == front ? Place::front_end : Place::inside};
  }
};

/// The iso-surfaces of a frame, for rasterizers.
struct IsoView {
  const scene::SurfaceSet* surfaces;
  const PixelSpace* space;
  /// The lattice to whose steps depths will be rounded; null: depths are not rounded.
  const scene::Lattice* lattice = nullptr;

  [[nodiscard]] std::span<const double> values() const { return surfaces->iso_values(); }

  /// Returns the number of a crossing at `depth` of a segment from `front` to `back`; sets `depth` to the crossing's
  /// final depth.
  [[nodiscard]] std::uint32_t number(std::size_t iso, bool rises, double& depth, double front, double back) const {
    if (lattice == nullptr) return surfaces->crossing(iso, rises, scene::SurfaceSet::place_of(depth, front, back));
    const auto at = LatticePlace::of(lattice->depth_step(depth), lattice->depth_step(front), lattice->depth_step(back));
    depth = lattice->depth(at.depth);
    return surfaces->crossing(iso, rises, at.place);
  }

  /// The range [first, last) of the surfaces in a cell with these scalars: those whose values are above `low`, up to
  /// `high`.
  struct Range {
    std::size_t first, last;
  };
  [[nodiscard]] Range within(double low, double high) const {
    const auto all = values();
    const auto first = std::upper_bound(all.begin(), all.end(), low), last = std::upper_bound(first, all.end(), high);
    return {static_cast<std::size_t>(first - all.begin()), static_cast<std::size_t>(last - all.begin())};
  }
};

/// Returns a vector, of any length, in the direction of the field's gradient in a tet of point data; zero if the field
/// is constant. For a flat tet, it is the normal of the tet.
glm::dvec3 gradient_direction(const PreparedMesh& mesh, std::size_t tet);
glm::dvec3 gradient_direction(const scene::TetMeshView& mesh, const scene::Tet& corners);

/// Returns the direction scaled to length 1; zero stays zero.
glm::dvec3 unit(const glm::dvec3& direction);

/// Returns the cosine of the angle between a ray's direction and a normal, which may have any length; 1 if there is no
/// normal.
float cosine_between(const glm::dvec3& ray, const glm::dvec3& normal);

}  // namespace tessera::projection
